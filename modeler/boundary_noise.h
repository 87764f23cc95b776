// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <span>

#include "formats/recipe.h"

namespace opal {

struct Ball {
    openvdb::Vec3d centre_mm;
    double radius_mm;
};

/// A smooth displacement d(x) of space that makes grain boundaries irregular: x belongs to the site that is nearest to x + d(x).
/// Each component is amplitude_mm times fractal gradient noise of x / scale_mm, so |d_k| <= amplitude_mm along each axis; the
/// three are independent.
class BoundaryNoise {
  public:
    /// Throws InputError for a scale too small for places as far from the origin as `bounds_mm`.
    BoundaryNoise(const BoundaryNoiseRecipe& recipe, std::uint64_t seed, const openvdb::BBoxd& bounds_mm);

    double amplitude_mm() const { return recipe_.amplitude_mm; }

    /// Turns each x into x + d(x). The result for a point does not depend on the others; points that lie together share work.
    void displace(std::span<openvdb::Vec3d> points_mm) const;

    /// x + d(x), mm.
    openvdb::Vec3d displaced(openvdb::Vec3d point_mm) const;

    /// A ball that holds x + d(x) for every x of the given one.
    Ball displaced(const Ball& ball) const;

    /// The largest change of d per distance, by the slope of gradient noise.
    double slope() const { return slope_; }

  private:
    void add_octave(std::span<const openvdb::Vec3d> places, std::uint32_t octave, double amplitude,
                    std::span<openvdb::Vec3d> sums) const;

    BoundaryNoiseRecipe recipe_;
    std::uint64_t seed_;
    double slope_;
};

}  // namespace opal
