// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "formats/command.h"
#include "renderer/host/checkpoint.h"
#include "renderer/render_options.h"

namespace opal {

/// Where the checkpoint of a picture lies.
std::filesystem::path checkpoint_path(std::filesystem::path output);

/// What became of a render's checkpoints, for the report.
struct CheckpointCounts {
    int written = 0, failed = 0;
    struct Resumed {
        double samples_per_pixel, render_s;
    };
    std::optional<Resumed> resumed_from;
};

/// Keeps the checkpoint of one render beside its output: finds an earlier one, writes anew at intervals by a thread of its own,
/// and rescues what is there where the output cannot be written.
class CheckpointKeeper {
  public:
    /// `output` is the picture's path. Nothing is read or written yet.
    CheckpointKeeper(const CheckpointOptions& options, const std::filesystem::path& output, std::string fingerprint, Film& film);
    ~CheckpointKeeper();
    CheckpointKeeper(const CheckpointKeeper&) = delete;
    CheckpointKeeper& operator=(const CheckpointKeeper&) = delete;

    /// With --resume fills the film from the checkpoint and throws InputError where there is none that fits, or where it already
    /// holds more than `samples` per pixel. Without, tells people of a checkpoint that is there.
    void find_earlier(int samples);

    /// Writes checkpoints at intervals from now on; where one cannot be written, warns and tries again next time.
    void start();
    /// Ends that, letting a checkpoint that is being written become whole.
    void stop();

    /// After stop(), when the outputs are there: removes the checkpoint, or writes the last one where the render was interrupted
    /// or it is to be kept.
    void remove_or_keep(bool interrupted);
    /// Where the outputs could not be written: writes the state beside them or, where that fails too, into the system's temporary
    /// folder, and throws SystemError that says where it lies and why it was needed.
    [[noreturn]] void rescue(const std::exception& cause);

    double earlier_s() const { return counts_.resumed_from ? counts_.resumed_from->render_s : 0.0; }
    const CheckpointCounts& counts() const { return counts_; }

  private:
    void write(const std::filesystem::path& path);
    bool try_to_write();
    void keep_writing(const std::stop_token& stop);

    const CheckpointOptions options_;
    const std::filesystem::path path_;
    const std::string fingerprint_;
    Film& film_;
    const Stopwatch watch_;
    CheckpointCounts counts_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread writer_;
};

}  // namespace opal
