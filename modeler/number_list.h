// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace opal {

/// The numbers of a .csv of one column, from top to bottom. The first line may be a heading; empty lines and lines that begin
/// with # are skipped. Throws InputError located at file:line where a line is not one finite number.
std::vector<double> read_number_list(const std::filesystem::path& file);

}  // namespace opal
