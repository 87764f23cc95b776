// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace opal {

/// The numbers that a flag names: one number, a list "a,b,c" or a range "first:last:step", which ends with `last` where the steps
/// meet it. Throws InputError naming the flag where the text is none of these, a number lies outside [low, high], or there are
/// more than a million.
std::vector<double> parse_values(const std::string& flag, const std::string& text, double low, double high);

}  // namespace opal
