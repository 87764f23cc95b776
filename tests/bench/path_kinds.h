// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// Paths from the camera that scattered, and were turned by lattice planes, about equally often; going back and forth between two
/// beams is one turn.
struct PathKind {
    std::string scatterings;   ///< "0", "1", "2-3", "4+"
    std::string diffractions;  ///< likewise
    double paths = 0.0;        ///< part of all paths
    double light = 0.0;        ///< part of the luminance that they find
    /// Part of the mean of (luminance of one sample)^2 / (the pixel's luminance^2 + 1 % of its mean over the pixels): of the
    /// noise.
    double second_moment = 0.0;
};

/// The kinds of paths with 3 companions and Sobol numbers over the gem's pixels of a scene, the largest share of the noise first.
/// Throws InputError.
std::vector<PathKind> path_kinds(const std::filesystem::path& scene_file, const std::filesystem::path& opal, int width,
                                 int samples);

}  // namespace opal
