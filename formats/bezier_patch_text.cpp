// SPDX-License-Identifier: Apache-2.0
#include "formats/bezier_patch_text.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <sstream>

#include "formats/error.h"

namespace opal {
namespace {

BezierPatch patch_from_line(const std::string& line, std::size_t number) {
    const auto fail = [&] { return InputError(fmt::format("line {}: is not a part's number and 48 coordinates", number)); };
    std::istringstream stream(line);
    BezierPatch patch;
    if (!(stream >> patch.part)) throw fail();
    for (auto& row : patch.control_mm)
        for (auto& point : row)
            for (double& coordinate : point)
                if (!(stream >> coordinate) || !std::isfinite(coordinate)) throw fail();
    std::string rest;
    if (stream >> rest) throw fail();
    return patch;
}

}  // namespace

std::string bezier_patches_to_text(const std::vector<BezierPatch>& patches) {
    std::string text;
    for (const BezierPatch& patch : patches) {
        text += fmt::format("{}", patch.part);
        for (const auto& row : patch.control_mm)
            for (const auto& point : row) fmt::format_to(std::back_inserter(text), " {} {} {}", point[0], point[1], point[2]);
        text += '\n';
    }
    return text;
}

std::vector<BezierPatch> bezier_patches_from_text(const std::string& text) {
    std::vector<BezierPatch> patches;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) patches.push_back(patch_from_line(line, patches.size() + 1));
    return patches;
}

}  // namespace opal
