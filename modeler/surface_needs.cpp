// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/surface_needs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "formats/command.h"
#include "formats/units.h"
#include "modeler/shape_sampler.h"

namespace opal {
namespace {

/// Places come from points of a box that reaches this part of the longest side beyond the shape: what lies outside is nearest to
/// edges and corners more often than to faces.
constexpr double box_margin = 0.1;
constexpr std::size_t num_tries = 1 << 13;
constexpr std::uint64_t sampling_seed = 1;
/// Of the longest side: step for normals, and how near a place has to come to the surface.
constexpr double normal_step = 1.0e-5, nearness = 1.0e-6;
constexpr int max_projections = 8;
/// From one size of voxels to the next finer one.
const double step_down = std::pow(2.0, -0.25);
/// The renderer takes normals from differences over a voxel to each side, of values that reach half a voxel farther.
constexpr double reach_along_normal = 1.5;

struct SurfacePlace {
    openvdb::Vec3d point_mm, normal;
    double accepted_mm;
};

openvdb::Vec3d normal_at(const Shape& shape, const openvdb::Vec3d& point_mm, double step_mm) {
    openvdb::Vec3d slope;
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d offset_mm(0.0);
        offset_mm[axis] = step_mm;
        slope[axis] = shape.signed_distance_mm(point_mm + offset_mm) - shape.signed_distance_mm(point_mm - offset_mm);
    }
    return slope.unitSafe();
}

std::vector<SurfacePlace> places_on(const Shape& shape, const AcceptedSurfaceError& accepted_mm) {
    openvdb::BBoxd box_mm = shape.bounds_mm();
    const openvdb::Vec3d extents_mm = box_mm.extents();
    const double longest_mm = std::max({extents_mm.x(), extents_mm.y(), extents_mm.z()});
    box_mm.expand(box_margin * longest_mm);
    const std::vector<openvdb::Vec3d> points_mm = sample_box(box_mm, num_tries, sampling_seed);
    std::vector<SurfacePlace> found(points_mm.size());
    tbb::parallel_for(std::size_t(0), points_mm.size(), [&](std::size_t n) {
        openvdb::Vec3d point_mm = points_mm[n];
        for (int k = 0; k < max_projections && !interrupt_requested(); ++k) {
            const double distance_mm = shape.signed_distance_mm(point_mm);
            const openvdb::Vec3d normal = normal_at(shape, point_mm, normal_step * longest_mm);
            if (std::abs(distance_mm) <= nearness * longest_mm) {
                found[n] = {point_mm, normal, normal.lengthSqr() > 0.0 ? accepted_mm(point_mm) : 0.0};
                return;
            }
            point_mm -= distance_mm * normal;
        }
    });
    throw_if_interrupted();
    std::erase_if(found, [](const SurfacePlace& place) { return !(place.accepted_mm > 0.0) || std::isinf(place.accepted_mm); });
    return found;
}

/// How far a level set of such voxels may be off around a place.
double error_mm(const Shape& shape, const SurfacePlace& place, double voxel_mm) {
    const openvdb::Vec3d aside = std::abs(place.normal.x()) < 0.5 ? openvdb::Vec3d(1.0, 0.0, 0.0) : openvdb::Vec3d(0.0, 1.0, 0.0);
    const openvdb::Vec3d u = place.normal.cross(aside).unit(), v = place.normal.cross(u);
    double error = 0.0;
    for (int k = 0; k < 8; ++k) {
        const double angle_rad = 0.25 * units::pi * k;
        const openvdb::Vec3d direction = std::cos(angle_rad) * u + std::sin(angle_rad) * v;
        error = std::max(error, std::abs(shape.signed_distance_mm(place.point_mm + voxel_mm * direction)));
    }
    const double reach_mm = reach_along_normal * voxel_mm;
    for (const double along_mm : {-reach_mm, reach_mm})
        error = std::max(error, std::abs(shape.signed_distance_mm(place.point_mm + along_mm * place.normal) - along_mm));
    return error;
}

std::vector<double> errors_mm(const Shape& shape, const std::vector<SurfacePlace>& places, double voxel_mm) {
    std::vector<double> errors(places.size());
    tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t n) {
        if (!interrupt_requested()) errors[n] = error_mm(shape, places[n], voxel_mm);
    });
    throw_if_interrupted();
    return errors;
}

SurfaceNeeds needs_with(const Shape& shape, const std::vector<SurfacePlace>& places, double voxel_mm) {
    const std::vector<double> errors = errors_mm(shape, places, voxel_mm);
    SurfaceNeeds needs{voxel_mm, 0.0, 0.0, places.size()};
    for (std::size_t n = 0; n < places.size(); ++n) {
        needs.error_mm = std::max(needs.error_mm, errors[n]);
        needs.error_over_accepted = std::max(needs.error_over_accepted, errors[n] / places[n].accepted_mm);
    }
    return needs;
}

/// Those places for which such voxels are too coarse.
std::vector<SurfacePlace> failing(const Shape& shape, const std::vector<SurfacePlace>& places, double voxel_mm) {
    const std::vector<double> errors = errors_mm(shape, places, voxel_mm);
    std::vector<SurfacePlace> result;
    for (std::size_t n = 0; n < places.size(); ++n)
        if (errors[n] > places[n].accepted_mm) result.push_back(places[n]);
    return result;
}

}  // namespace

SurfaceNeeds coarsest_surface_voxels(const Shape& shape, const AcceptedSurfaceError& accepted_mm, double finest_mm,
                                     double coarsest_mm) {
    const std::vector<SurfacePlace> places = places_on(shape, accepted_mm);
    const SurfaceNeeds finest = needs_with(shape, places, finest_mm);
    if (finest.error_over_accepted > 1.0) return finest;
    // A place rarely is worse with finer voxels, so only those that failed are looked at again; what is accepted holds for all.
    std::vector<SurfacePlace> critical = places;
    for (double voxel_mm = coarsest_mm; voxel_mm > finest_mm; voxel_mm *= step_down) {
        critical = failing(shape, critical, voxel_mm);
        if (!critical.empty()) continue;
        const SurfaceNeeds needs = needs_with(shape, places, voxel_mm);
        if (needs.error_over_accepted <= 1.0) return needs;
        critical = places;
    }
    return finest;
}

}  // namespace opal
