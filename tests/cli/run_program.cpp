// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../renderer/small_opal.h"

namespace opal {
namespace {

std::string content(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

}  // namespace

ProgramResult run_program(const std::string& command) {
    const ScratchFolder folder;
    const std::string line = "( " + command + " ) >" + (folder / "out").string() + " 2>" + (folder / "err").string();
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, content(folder / "out"), content(folder / "err")};
}

void expect_failure(const std::string& command, int exit_code, const std::string& part) {
    SCOPED_TRACE(command);
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    const std::size_t first = result.err.find("error: ");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("error: ", first + 1), std::string::npos) << "more than one error line: " << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

std::size_t count_files(const std::string& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace opal
