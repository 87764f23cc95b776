// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace opal {

struct ProgramResult {
    int exit_code = -1;
    std::string out;  ///< standard output
    std::string err;  ///< standard error
};

/// Runs a shell command to its end.
ProgramResult run_program(const std::string& command);

/// A command that must fail with one line "error: ..." that contains `part`, and the given exit code.
void expect_failure(const std::string& command, int exit_code, const std::string& part);

/// Files in a folder, hidden ones counted.
std::size_t count_files(const std::string& folder);

inline const std::string opal_model = OPAL_MODEL;
inline const std::string opal_render = OPAL_RENDER;
inline const std::string opal_optics = OPAL_OPTICS;
inline const std::string examples = OPAL_EXAMPLES;

}  // namespace opal
