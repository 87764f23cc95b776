// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// How fast pictures of the black, the white and the fire opal of examples/ converge with one independent wavelength per path,
/// with companions, with the samplers and with guided scattering, in the studio and in the light tent. Writes into `folder`:
///  - convergence.csv: per scene, light, setting and number of samples the relative mean square error of luminance and of
///    chroma over the gem's pixels, each with its standard error, and the time that the samples took;
///  - convergence_ratios.csv: per scene, light and setting how many times fewer samples, and how much less time, reach the
///    error that one independent wavelength per path has at the most samples;
///  - convergence_paths.csv: per scene, in the studio, which kinds of paths the noise comes from (path_kinds).
/// `quick`: fewer pixels and samples. Throws InputError and SystemError.
void bench_convergence(const std::filesystem::path& folder, bool quick);

}  // namespace opal
