// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace opal::fuzz {

struct ProgramRun {
    int exit_code = 0;
    std::string text;  ///< standard output and error, as they came
};

/// Runs opal-render or opal-model (the first word) in this process, with what it prints caught.
ProgramRun run_program(const std::vector<std::string>& command);

}  // namespace opal::fuzz
