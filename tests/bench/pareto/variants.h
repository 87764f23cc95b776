// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drawings.h"
#include "spectral_lines.h"

namespace opal {

/// One of the opals that choices are compared on.
struct ParetoScene {
    std::string name;
    std::filesystem::path recipe, scene;
    double longest_mm = 0.0;  ///< side of the shape
    bool scatters = false;
    bool varies = false;                                              ///< its coefficients, and its indices over the wavelength
    bool patches_alone = false;                                       ///< here for one choice: its Bezier patches or triangles
    double sphere_diameter_nm = 0.0, n_sphere = 0.0, n_medium = 0.0;  ///< at the sodium line
};

/// One value of one choice: what differs from the default settings.
struct ParetoVariant {
    std::string choice = {}, name = {};
    std::vector<std::string> recipe = {}, scene = {};  ///< --set of opal-model and of opal-render
    SpectralChoice spectral = SpectralChoice::continuous;
    std::string for_pixels = {};  ///< opal-model build --for SCENE --for-pixels
    bool exact = false;           ///< the most exact of its choice: the others are measured against it
    Tracing tracing = Tracing::embree;
};

std::vector<ParetoScene> pareto_scenes(const std::filesystem::path& examples, const std::filesystem::path& block, bool quick);

/// All choices for a scene, those of one choice together, the exact one among them. Those that cannot matter there are left out
/// (phase functions where nothing scatters).
std::vector<std::vector<ParetoVariant>> pareto_choices(const ParetoScene& scene, bool quick);

}  // namespace opal
