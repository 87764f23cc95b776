// SPDX-License-Identifier: Apache-2.0
#include "renderer/checkpoint_keeper.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/text.h"
#include "renderer/host/render_fingerprint.h"

namespace opal {

std::filesystem::path checkpoint_path(std::filesystem::path output) {
    return output.replace_extension(".checkpoint");
}

CheckpointKeeper::CheckpointKeeper(const CheckpointOptions& options, const std::filesystem::path& output, std::string fingerprint,
                                   Film& film)
    : options_(options), path_(checkpoint_path(output)), fingerprint_(std::move(fingerprint)), film_(film) {}

CheckpointKeeper::~CheckpointKeeper() {
    stop();
}

void CheckpointKeeper::find_earlier(int samples) {
    remove_abandoned_temporaries(path_);
    std::error_code error;
    const bool exists = std::filesystem::exists(path_, error);
    if (!options_.resume) {
        if (exists)
            fmt::print(stderr, "opal-render: note: {} holds an earlier render, which --resume would continue; starting afresh\n",
                       path_.string());
        return;
    }
    if (!exists)
        throw InputError(fmt::format("--resume: there is no {} (it is removed when a render ends, but for --keep-checkpoint)",
                                     path_.string()));
    const CheckpointHeader header = read_checkpoint_header(path_);
    const std::string difference = fingerprint_difference(header.fingerprint, "the checkpoint", fingerprint_, "this render");
    if (!difference.empty()) throw InputError(fmt::format("--resume: {}: of another render: {}", path_.string(), difference));
    read_checkpoint(path_, film_);
    for (int b = 0; b < film_.num_blocks(); ++b)
        if (film_.block(b).end_sample > std::uint32_t(samples))
            throw InputError(fmt::format("--resume: {}: already has {} samples per pixel, more than the {} asked for",
                                         path_.string(), film_.block(b).end_sample, samples));
    const double samples_per_pixel = double(film_.total_samples()) / (double(film_.width()) * double(film_.height()));
    counts_.resumed_from = {samples_per_pixel, header.render_s};
    fmt::print(stderr, "opal-render: note: going on from {}: {:.1f} samples per pixel, {} of rendering\n", path_.string(),
               samples_per_pixel, format_duration(header.render_s));
}

void CheckpointKeeper::start() {
    if (options_.interval_s > 0.0) writer_ = std::jthread([this](const std::stop_token& stop) { keep_writing(stop); });
}

void CheckpointKeeper::stop() {
    writer_.request_stop();
    if (writer_.joinable()) writer_.join();
}

void CheckpointKeeper::keep_writing(const std::stop_token& stop) {
    const auto interval = std::chrono::duration<double>(options_.interval_s);
    while (true) {
        {
            std::unique_lock lock(mutex_);
            wake_.wait_for(lock, stop, interval, [] { return false; });
        }
        if (stop.stop_requested()) return;
        try_to_write();
    }
}

void CheckpointKeeper::write(const std::filesystem::path& path) {
    write_checkpoint(path, film_, {fingerprint_, earlier_s() + watch_.seconds()});
}

bool CheckpointKeeper::try_to_write() {
    try {
        write(path_);
        ++counts_.written;
        return true;
    } catch (const std::exception& error) {
        ++counts_.failed;
        fmt::print(stderr, "opal-render: warning: no checkpoint: {}; the render goes on and tries again\n",
                   one_line(error.what()));
        return false;
    }
}

void CheckpointKeeper::remove_or_keep(bool interrupted) {
    if (options_.keep || (interrupted && options_.interval_s > 0.0)) {
        if (try_to_write()) fmt::print(stderr, "opal-render: note: --resume goes on from {}\n", path_.string());
        return;
    }
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

void CheckpointKeeper::rescue(const std::exception& cause) {
    const std::string name = path_.filename().string();
    std::error_code error;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
    for (const std::filesystem::path& place :
         {path_, temporary / fmt::format("{}.{}.checkpoint", path_.stem().string(), ::getpid())}) {
        try {
            write(place);
        } catch (const std::exception&) {
            continue;
        }
        throw SystemError(fmt::format("{}; the render is kept in {}: {}the same command with --resume goes on from it",
                                      cause.what(), place.string(),
                                      place == path_ ? "" : fmt::format("as {} beside the output, ", name)));
    }
    if (std::filesystem::exists(path_, error))
        throw SystemError(fmt::format("{}; {} holds what was rendered until it was written", cause.what(), path_.string()));
    throw SystemError(
        fmt::format("{}; nor could the render's state be kept beside it or in {}", cause.what(), temporary.string()));
}

}  // namespace opal
