// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace opal {

/// Runs docs/charts/`script` on `csv`, with the picture beside it; where no Python with matplotlib is there, or the script is
/// not, a note says how to draw it.
void draw_chart(const std::string& script, const std::filesystem::path& csv);

}  // namespace opal
