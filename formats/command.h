// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace opal {

/// Runs a command's body: prints one "error: ..." line for whatever it throws and returns the exit code of the contract
/// (0 success, 2 bad input, 1 other failures). Turns SIGXFSZ and SIGPIPE into ordinary write errors.
int run_command(const std::string& program, const std::function<int()>& body);

/// From now on Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the process; a second one ends it.
void catch_interrupts();
/// Whether one came.
bool interrupt_requested();
/// Throws Interrupted if one came.
void throw_if_interrupted();

/// Progress on standard error: a line rewritten in place with the time left on a terminal. Piped, plain lines for a log: at most
/// one in ten seconds, and then only where a hundredth more is done or a minute has passed. Safe to call from several threads.
class Progress {
  public:
    explicit Progress(std::string task);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `fraction` of the work that is done, in [0, 1]. `note` is asked for more to say (empty: nothing), only when a line is due.
    void update(double fraction, const std::function<std::string()>& note = {});

  private:
    struct State;
    State* state_;
};

/// Seconds since the object was made.
class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// "1:02:03", "4:05" or "12 s".
std::string format_duration(double seconds);

}  // namespace opal
