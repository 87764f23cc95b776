// SPDX-License-Identifier: Apache-2.0
#include "formats/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <new>

#include "formats/error.h"
#include "formats/text.h"

namespace opal {
namespace {

// A signal handler can reach nothing but a flag of static storage.
volatile std::sig_atomic_t interrupt_flag = 0;

void on_interrupt(int signal_number) {
    if (interrupt_flag != 0) {
        std::signal(signal_number, SIG_DFL);
        std::raise(signal_number);
    }
    interrupt_flag = 1;
}

}  // namespace

int run_command(const std::string& program, const std::function<int()>& body) {
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        return body();
    } catch (const InputError& error) {
        fmt::print(stderr, "{}: error: {}\n", program, one_line(error.what()));
        return 2;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "{}: error: out of memory\n", program);
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: error: {}\n", program, one_line(error.what()));
        return 1;
    }
}

void catch_interrupts() {
    struct sigaction action = {};
    action.sa_handler = on_interrupt;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() {
    return interrupt_flag != 0;
}

void throw_if_interrupted() {
    if (interrupt_requested()) throw Interrupted();
}

struct Progress::State {
    std::string task;
    Stopwatch watch;
    std::mutex mutex;
    double last_print_s = 0.0;
    double last_fraction = 0.0;
    bool terminal = ::isatty(2) != 0;
    bool printed = false;
};

Progress::Progress(std::string task) : state_(new State) {
    state_->task = std::move(task);
}

Progress::~Progress() {
    if (state_->terminal && state_->printed) fmt::print(stderr, "\r\033[K");
    delete state_;
}

void Progress::update(double fraction, const std::function<std::string()>& note) {
    const std::scoped_lock lock(state_->mutex);
    const double now_s = state_->watch.seconds(), since_s = now_s - state_->last_print_s;
    const bool due =
        state_->terminal ? since_s >= 0.2 : since_s >= 10.0 && (fraction >= state_->last_fraction + 0.01 || since_s >= 60.0);
    if (!due) return;
    state_->last_print_s = now_s;
    state_->last_fraction = fraction;
    state_->printed = true;
    std::string line = fmt::format("{}: {:.0f} %, {} so far", state_->task, 100.0 * fraction, format_duration(now_s));
    if (fraction > 0.0) line += ", " + format_duration(now_s * (1.0 - fraction) / fraction) + " left";
    if (const std::string more = note ? note() : ""; !more.empty()) line += ", " + more;
    fmt::print(stderr, "{}{}{}", state_->terminal ? "\r\033[K" : "", line, state_->terminal ? "" : "\n");
    std::fflush(stderr);
}

std::string format_duration(double seconds) {
    const long total = static_cast<long>(seconds + 0.5);
    if (total >= 3600) return fmt::format("{}:{:02}:{:02}", total / 3600, total / 60 % 60, total % 60);
    if (total >= 60) return fmt::format("{}:{:02}", total / 60, total % 60);
    if (total >= 10) return fmt::format("{} s", total);
    return fmt::format("{:.1f} s", seconds);
}

}  // namespace opal
