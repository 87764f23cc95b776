// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/boundary_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "formats/error.h"
#include "modeler/gradient_noise.h"

namespace opal {
namespace {

/// Points are worked on together where the lattice around them has at most so many points along each axis.
constexpr double max_table_size = 12.0;
/// Beyond this many cells from the origin too few places in a cell are told apart.
constexpr double max_lattice_coordinate = 0x1p40;

/// Gradients of the three components at one lattice point.
struct GradientTriple {
    openvdb::Vec3d gradient[3];

    openvdb::Vec3d slopes(const openvdb::Vec3d& offset) const {
        return {gradient[0].dot(offset), gradient[1].dot(offset), gradient[2].dot(offset)};
    }
};

openvdb::Vec3d floor_of(const openvdb::Vec3d& v) {
    return {std::floor(v.x()), std::floor(v.y()), std::floor(v.z())};
}

/// The gradients at a box of lattice points.
class GradientTable {
  public:
    GradientTable(const openvdb::Vec3d& first, const openvdb::Vec3d& sizes, std::uint64_t seed, std::uint32_t octave)
        : first_(first), size_y_(static_cast<std::size_t>(sizes.y())), size_z_(static_cast<std::size_t>(sizes.z())) {
        const auto source = [&](std::uint32_t axis) {
            return NoiseSource{seed, RandomStream::boundary_noise, axis * max_octaves};
        };
        for (double i = 0.0; i < sizes.x(); ++i)
            for (double j = 0.0; j < sizes.y(); ++j)
                for (double k = 0.0; k < sizes.z(); ++k) {
                    const openvdb::Vec3d point = first + openvdb::Vec3d(i, j, k);
                    table_.push_back({{lattice_gradient(point, source(0), octave), lattice_gradient(point, source(1), octave),
                                       lattice_gradient(point, source(2), octave)}});
                }
    }

    /// The three noises, before they are scaled to [-1, 1].
    openvdb::Vec3d blended(const openvdb::Vec3d& place) const {
        const openvdb::Vec3d cell = floor_of(place);
        const openvdb::Vec3d offset = place - cell;
        const openvdb::Vec3d index = cell - first_;
        const GradientTriple* const corner =
            &table_[(static_cast<std::size_t>(index.x()) * size_y_ + static_cast<std::size_t>(index.y())) * size_z_ +
                    static_cast<std::size_t>(index.z())];
        return blend_corners(offset, [&](std::size_t i, std::size_t j, std::size_t k) {
            return corner[(i * size_y_ + j) * size_z_ + k].slopes(
                offset - openvdb::Vec3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
        });
    }

  private:
    openvdb::Vec3d first_;
    std::size_t size_y_, size_z_;
    std::vector<GradientTriple> table_;
};

}  // namespace

BoundaryNoise::BoundaryNoise(const BoundaryNoiseRecipe& recipe, std::uint64_t seed, const openvdb::BBoxd& bounds_mm)
    : recipe_(recipe), seed_(seed) {
    const double farthest_mm = std::max(bounds_mm.min().length(), bounds_mm.max().length());
    if (!(std::ldexp(farthest_mm / recipe.scale_mm, recipe.octaves) <= max_lattice_coordinate))
        throw InputError(fmt::format("grains.boundary_noise.scale_mm {}: too small for a shape of this size", recipe.scale_mm));
    // Every octave is half as strong and twice as fine as the one before, so all have the slope of the first. The components'
    // gradients add up as the sides of a box do.
    const double total_amplitude = 2.0 - std::ldexp(1.0, 1 - recipe.octaves);
    slope_ = std::sqrt(3.0) * recipe.amplitude_mm / recipe.scale_mm * gradient_noise_slope * recipe.octaves / total_amplitude;
}

void BoundaryNoise::displace(std::span<openvdb::Vec3d> points_mm) const {
    std::vector<openvdb::Vec3d> places(points_mm.size()), sums(points_mm.size(), openvdb::Vec3d(0.0));
    for (std::size_t n = 0; n < places.size(); ++n) places[n] = points_mm[n] / recipe_.scale_mm;
    double total_amplitude = 0.0, amplitude = 1.0;
    for (int octave = 0; octave < recipe_.octaves; ++octave) {
        add_octave(places, static_cast<std::uint32_t>(octave), amplitude, sums);
        total_amplitude += amplitude;
        amplitude *= 0.5;
        for (openvdb::Vec3d& place : places) place *= 2.0;
    }
    const double scale = gradient_noise_scale / total_amplitude;
    for (std::size_t n = 0; n < places.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
            points_mm[n][axis] += recipe_.amplitude_mm * std::clamp(sums[n][axis] * scale, -1.0, 1.0);
}

void BoundaryNoise::add_octave(std::span<const openvdb::Vec3d> places, std::uint32_t octave, double amplitude,
                               std::span<openvdb::Vec3d> sums) const {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& place : places) box.expand(place);
    const openvdb::Vec3d first = floor_of(box.min());
    const openvdb::Vec3d sizes = floor_of(box.max()) - first + openvdb::Vec3d(2.0);
    if (std::max({sizes.x(), sizes.y(), sizes.z()}) > max_table_size) {
        for (std::size_t n = 0; n < places.size(); ++n) add_octave(places.subspan(n, 1), octave, amplitude, sums.subspan(n, 1));
        return;
    }
    const GradientTable table(first, sizes, seed_, octave);
    for (std::size_t n = 0; n < places.size(); ++n) sums[n] += table.blended(places[n]) * amplitude;
}

openvdb::Vec3d BoundaryNoise::displaced(openvdb::Vec3d point_mm) const {
    displace({&point_mm, 1});
    return point_mm;
}

Ball BoundaryNoise::displaced(const Ball& ball) const {
    // Near the centre the displacement is nearly the centre's; farther away only its bound is known. Places are rounded when they
    // are divided by the scale.
    const double rounding_mm = 8.0 * std::numeric_limits<double>::epsilon() * (ball.centre_mm.length() + ball.radius_mm);
    const double change_mm = slope_ * (ball.radius_mm + rounding_mm), bound_mm = std::sqrt(3.0) * recipe_.amplitude_mm;
    if (change_mm < bound_mm) return {displaced(ball.centre_mm), ball.radius_mm + change_mm};
    return {ball.centre_mm, ball.radius_mm + bound_mm};
}

}  // namespace opal
