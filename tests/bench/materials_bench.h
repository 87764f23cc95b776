// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace opal {

/// Writes folder/metals.csv, the reflectance of the built-in metals at normal incidence over the wavelength, and
/// folder/rough_surfaces.csv: the share of light that leaves a perfect metal and glass (index 1.45) after a single turn, over
/// roughness and cosine; what turns more often is what models of single scattering lose.
void bench_materials(const std::filesystem::path& folder);

}  // namespace opal
