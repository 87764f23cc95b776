// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// A site of the additively weighted Voronoi diagram: a place x belongs to the site with the smallest |x - p| - w.
struct CellSite {
    float x = 0.0f, y = 0.0f, z = 0.0f;  ///< object space, mm
    float weight_mm = 0.0f;

    OPAL_HD Vec3 position() const { return {x, y, z}; }
};

/// The cells of an opal as their sites and, for each, the sites whose cells may border its own. Only sites that own something
/// are here; sites near to one another in space are so in memory.
struct CellField {
    const CellSite* sites = nullptr;
    const int32_t* grain = nullptr;       ///< of each site, from 1
    const uint32_t* first = nullptr;      ///< where a site's neighbours begin; one more than there are sites
    const int32_t* neighbors = nullptr;   ///< readable OPAL_CELL_LANES - 1 past the end
    const int32_t* start_site = nullptr;  ///< a site near each box of a coarse grid, x fastest
    Vec3 grid_origin;                     ///< object space, mm
    real boxes_per_mm = 1.0f;
    int boxes[3] = {1, 1, 1};
    int num_sites = 0;
    /// Times the distance between two sites: by how much (mm^2) the walk's single precision may err in what tells their cells
    /// apart. A boundary counts as crossed where the difference exceeds it.
    real rounding_mm = 0.0f;
};

/// delta of a site at a place.
OPAL_HD inline real delta_mm(const CellSite& site, Vec3 position) {
    return length(position - site.position()) - site.weight_mm;
}

/// No place nearer than this to one in a cell lies in another cell; 0 where the place itself does. Half of what the nearest
/// neighbour is behind by, as each delta is 1-Lipschitz.
OPAL_HD inline real cell_clearance_mm(const CellField& field, Vec3 position, int cell) {
    real second_mm = 3.0e38f;
    for (uint32_t k = field.first[cell]; k < field.first[cell + 1]; ++k)
        second_mm = min_of(second_mm, delta_mm(field.sites[field.neighbors[k]], position));
    return max_of(0.0f, 0.5f * (second_mm - delta_mm(field.sites[cell], position)) - field.rounding_mm);
}

/// Where a ray has left a box for good; below 0 where that is behind its origin.
OPAL_HD inline real way_out_mm(Vec3 low, Vec3 high, Vec3 origin, Vec3 direction) {
    const auto along = [](real low_mm, real high_mm, real origin_mm, real component) {
        return component == 0.0f ? real(3.0e38f) : ((component > 0.0f ? high_mm : low_mm) - origin_mm) / component;
    };
    return min_of(along(low.x, high.x, origin.x, direction.x),
                  min_of(along(low.y, high.y, origin.y, direction.y), along(low.z, high.z, origin.z, direction.z)));
}

/// A site whose cell is likely to be near a place.
OPAL_HD inline int nearby_cell(const CellField& field, Vec3 position) {
    const Vec3 box = field.boxes_per_mm * (position - field.grid_origin);
    // The comparisons are written so that a place that is not a number finds a box too.
    const auto index = [](real at, int count) { return at > 0.0f ? int(min_of(at, real(count - 1))) : 0; };
    const int x = index(box.x, field.boxes[0]), y = index(box.y, field.boxes[1]), z = index(box.z, field.boxes[2]);
    return field.start_site[(z * field.boxes[1] + y) * field.boxes[0] + x];
}

/// The cell that holds a place, by steps to a neighbour that is nearer until none is. The straight line from a site to a place
/// that it does not own leaves its cell through a neighbour that is nearer to the place, so the steps end at the owner (to
/// rounding) from any start; a good one saves steps.
OPAL_HD inline int locate_cell(const CellField& field, Vec3 position, int start) {
    int cell = start;
    real nearest_mm = delta_mm(field.sites[cell], position);
    while (true) {
        int next = cell;
        for (uint32_t k = field.first[cell]; k < field.first[cell + 1]; ++k) {
            const real candidate_mm = delta_mm(field.sites[field.neighbors[k]], position);
            if (candidate_mm < nearest_mm) {
                nearest_mm = candidate_mm;
                next = field.neighbors[k];
            }
        }
        if (next == cell) return cell;
        cell = next;
    }
}

}  // namespace opal
