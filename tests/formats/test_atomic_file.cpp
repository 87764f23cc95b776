// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "expect_error.h"
#include "formats/atomic_file.h"

namespace opal {
namespace {

std::string content(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

class AtomicFileTest : public testing::Test {
  protected:
    AtomicFileTest() { std::filesystem::create_directories(folder_); }
    ~AtomicFileTest() override { std::filesystem::remove_all(folder_); }

    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }

    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("opal_atomic_file_test_" + std::to_string(::getpid()));
};

TEST_F(AtomicFileTest, AppearsOnCommitOnly) {
    const auto path = folder_ / "a.txt";
    write_text_file(path, "old");
    {
        AtomicFile file(path);
        std::ofstream(file.temporary_path()) << "new";
        EXPECT_EQ(content(path), "old");
    }
    EXPECT_EQ(content(path), "old");
    EXPECT_EQ(files(), 1u);
    write_text_file(path, "new");
    EXPECT_EQ(content(path), "new");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, RefusesWhatCannotBeWritten) {
    EXPECT_INPUT_ERROR(require_writable(folder_ / "missing" / "a.txt"), "does not exist");
    EXPECT_INPUT_ERROR(require_writable(folder_), "is a folder");
    EXPECT_INPUT_ERROR(require_writable(""), "not a file name");
    EXPECT_INPUT_ERROR(require_writable("/dev/null"), "is a device");
    EXPECT_INPUT_ERROR(require_writable("/proc/a.txt"), "cannot be written");
}

TEST_F(AtomicFileTest, WhatAKilledProcessLeftIsRemoved) {
    // A child that ends without a destructor, as by a kill.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        AtomicFile file(folder_ / "a.state");
        std::ofstream(file.temporary_path()) << "half";
        ::_exit(0);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    AtomicFile own(folder_ / "a.state");
    std::ofstream(own.temporary_path()) << "in the making";
    std::ofstream(folder_ / ".a.notes.tmp.state") << "another's";
    EXPECT_EQ(files(), 3u);
    remove_abandoned_temporaries(folder_ / "a.state");
    EXPECT_EQ(files(), 2u);
    EXPECT_EQ(content(own.temporary_path()), "in the making");
}

}  // namespace
}  // namespace opal
