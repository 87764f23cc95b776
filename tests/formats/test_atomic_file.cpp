// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
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

}  // namespace
}  // namespace opal
