// SPDX-License-Identifier: Apache-2.0
#include "formats/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>

#include "formats/error.h"

namespace opal {
namespace {

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
    return folder_of(path) / fmt::format(".{}.{}.tmp{}", path.stem().string(), ::getpid(), path.extension().string());
}

void sync_path(const std::filesystem::path& path, int flags) {
    const int descriptor = ::open(path.c_str(), flags);
    if (descriptor < 0) throw SystemError(fmt::format("{}: cannot reopen: {}", path.string(), std::strerror(errno)));
    const int failed = ::fsync(descriptor);
    const int error = errno;
    ::close(descriptor);
    if (failed != 0 && error != EINVAL && error != EROFS)
        throw SystemError(fmt::format("{}: cannot flush to disk: {}", path.string(), std::strerror(error)));
}

}  // namespace

void require_writable(const std::filesystem::path& path) {
    if (path.empty() || !path.has_filename()) throw InputError(fmt::format("output '{}': not a file name", path.string()));
    std::error_code error;
    const std::filesystem::path folder = folder_of(path);
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("output {}: folder '{}' does not exist", path.string(), folder.string()));
    if (std::filesystem::is_directory(path, error))
        throw InputError(fmt::format("output {}: is a folder; name a file", path.string()));
    // Renaming the finished file onto a device or a pipe would take its place in the file system.
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("output {}: is a device or a pipe; name a file", path.string()));
    const std::filesystem::path probe = temporary_name(path);
    const int descriptor = ::open(probe.c_str(), O_CREAT | O_WRONLY, 0666);
    if (descriptor < 0) throw InputError(fmt::format("output {}: cannot be written: {}", path.string(), std::strerror(errno)));
    ::close(descriptor);
    ::unlink(probe.c_str());
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), temporary_path_(temporary_name(path_)) {
    require_writable(path_);
}

AtomicFile::~AtomicFile() {
    if (committed_) return;
    std::error_code ignored;
    std::filesystem::remove(temporary_path_, ignored);
}

void AtomicFile::commit() {
    sync_path(temporary_path_, O_RDONLY);
    std::error_code error;
    std::filesystem::rename(temporary_path_, path_, error);
    if (error) throw SystemError(fmt::format("{}: cannot be put in place: {}", path_.string(), error.message()));
    committed_ = true;
    sync_path(folder_of(path_), O_RDONLY | O_DIRECTORY);
}

void remove_abandoned_temporaries(const std::filesystem::path& path) {
    const std::string before = fmt::format(".{}.", path.stem().string()), after = ".tmp" + path.extension().string();
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_of(path), ignored)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(before) || !name.ends_with(after) || name.size() <= before.size() + after.size()) continue;
        pid_t process = 0;
        const char* const end = name.data() + name.size() - after.size();
        const auto [next, error] = std::from_chars(name.data() + before.size(), end, process);
        if (error != std::errc() || next != end || process <= 0) continue;
        if (::kill(process, 0) != 0 && errno == ESRCH) std::filesystem::remove(entry.path(), ignored);
    }
}

void write_text_file(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    std::ofstream stream(file.temporary_path(), std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw SystemError(fmt::format("{}: writing failed: {}", path.string(), std::strerror(errno)));
    file.commit();
}

}  // namespace opal
