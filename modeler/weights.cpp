// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/weights.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/error.h"
#include "modeler/gradient_noise.h"
#include "modeler/point_grid.h"

namespace opal {

std::vector<Site> weigh_sites(const SiteSet& sites, const GrainsRecipe& recipe) {
    const WeightTerm& weight = recipe.weight.front();
    const bool weighted = recipe.tessellation == TessellationKind::additive && weight.kind == WeightKind::perlin;
    std::vector<Site> weighed(sites.positions_mm.size());
    tbb::parallel_for(std::size_t(0), weighed.size(), [&](std::size_t n) {
        weighed[n].position_mm = sites.positions_mm[n];
        if (!weighted) return;
        const double noise = fractal_noise(sites.positions_mm[n] / weight.scale_mm, recipe.seed, weight.octaves);
        if (!std::isfinite(noise))
            throw InputError(fmt::format("grains.weight.scale_mm {}: too small for a shape of this size", weight.scale_mm));
        weighed[n].weight_mm = static_cast<float>(weight.amplitude * sites.shortest_distance_mm * noise);
    });
    return weighed;
}

std::vector<char> find_hidden_sites(const std::vector<Site>& sites, double spacing_mm) {
    std::vector<openvdb::Vec3d> positions_mm(sites.size());
    double largest_weight_mm = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < sites.size(); ++n) {
        positions_mm[n] = sites[n].position_mm;
        largest_weight_mm = std::max(largest_weight_mm, static_cast<double>(sites[n].weight_mm));
    }
    const PointGrid grid(positions_mm, spacing_mm);
    std::vector<char> hidden(sites.size(), 0);
    tbb::parallel_for(std::size_t(0), sites.size(), [&](std::size_t n) {
        const double weight_mm = static_cast<double>(sites[n].weight_mm);
        const auto hides = [&](std::size_t other, double squared_mm2) {
            if (other == n) return false;
            const double lead_mm = static_cast<double>(sites[other].weight_mm) - weight_mm;
            const double distance_mm = std::sqrt(squared_mm2);
            return lead_mm > distance_mm || (lead_mm == distance_mm && (distance_mm > 0.0 || other < n));
        };
        // No site farther away than its possible lead can hide this one; the factor covers rounding.
        hidden[n] = grid.any_within(positions_mm[n], (largest_weight_mm - weight_mm) * (1.0 + 1.0e-12), hides) ? 1 : 0;
    });
    return hidden;
}

}  // namespace opal
