// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "formats/image.h"
#include "modeler/percolation.h"

namespace opal {

/// What a percolation plot shows.
struct PercolationPlot {
    PercolationCurve curve;
    std::size_t num_visible = 0;
    std::string title;
    std::optional<double> marked_p;  ///< where the recipe stands
};

/// Draws grains per site and the largest grain's part of the sites over p, with the threshold, as display-encoded RGB (PLplot).
Image draw_percolation_plot(const PercolationPlot& plot);

}  // namespace opal
