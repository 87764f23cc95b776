// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace opal {

/// An output that appears whole or not at all: write to `temporary_path()`, then `commit()`. The temporary lies in the same
/// folder and keeps the extension, so that libraries that choose a format by name choose right. Without a commit it is removed.
class AtomicFile {
  public:
    /// Throws InputError where the folder does not exist or cannot be written.
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& temporary_path() const { return temporary_path_; }

    /// Forces the bytes to disk and renames. Throws SystemError, leaving an earlier file of that name as it was.
    void commit();

  private:
    std::filesystem::path path_;
    std::filesystem::path temporary_path_;
    bool committed_ = false;
};

/// Removes what processes that no longer run left of a file that they were writing at `path` when they were killed.
void remove_abandoned_temporaries(const std::filesystem::path& path);

/// Throws InputError where no file could be created at `path`: asked before long work begins.
void require_writable(const std::filesystem::path& path);

/// Writes a whole text file atomically. Throws InputError or SystemError.
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace opal
