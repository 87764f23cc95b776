// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cell_oracle.h"
#include "formats/random.h"
#include "renderer/host/cell_data.h"

/// Random sites in a cube about the origin, and walks along random rays there against the oracle.
namespace opal::cell_samples {

inline constexpr double half_mm = 10.0;

class Draws {
  public:
    explicit Draws(std::uint64_t seed) : seed_(seed) {}
    double next() {
        if (word_ == 4) {
            block_ = random_block(seed_, RandomStream::bench, index_++, 0);
            word_ = 0;
        }
        return double(uniform_float(block_.value[word_++]));
    }
    double signed_next() { return 2.0 * next() - 1.0; }
    openvdb::Vec3d in_cube(double half) {
        const double x = signed_next(), y = signed_next(), z = signed_next();
        return half * openvdb::Vec3d(x, y, z);
    }
    Vec3 direction() {
        while (true) {
            const openvdb::Vec3d v = in_cube(1.0);
            if (v.lengthSqr() > 1.0 || v.lengthSqr() < 0.01) continue;
            return normalize({real(v.x()), real(v.y()), real(v.z())});
        }
    }

  private:
    std::uint64_t seed_, index_ = 0;
    RandomBlock block_{};
    int word_ = 4;
};

inline ConvexBounds cube() {
    ConvexBounds bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.hold(half_mm * openvdb::Vec3d((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                             (corner & 4) != 0 ? 1.0 : -1.0));
    return bounds;
}

inline Vec3 to_vec3(const openvdb::Vec3d& v) {
    return {float(v.x()), float(v.y()), float(v.z())};
}

/// The places of sites as the walk holds them: rounding moves a site, not a boundary found between sites.
inline openvdb::Vec3d rounded(const openvdb::Vec3d& v) {
    return {double(float(v.x())), double(float(v.y())), double(float(v.z()))};
}

/// Random sites with weights up to `spread` mm apart, each a grain of its own. A grain may hide another, and then owns nothing.
inline std::vector<Site> random_sites(std::size_t count, double spread_mm, std::uint64_t seed) {
    Draws draws(seed);
    std::vector<Site> sites;
    for (std::size_t n = 0; n < count; ++n)
        sites.push_back({rounded(draws.in_cube(half_mm)), float(spread_mm * draws.next()), std::int32_t(n) + 1});
    return sites;
}

/// Distance to the cube's surface along a ray.
inline real way_out_mm(Vec3 origin, Vec3 direction) {
    const real o[3] = {origin.x, origin.y, origin.z}, v[3] = {direction.x, direction.y, direction.z};
    real end = 1.0e30f;
    for (int axis = 0; axis < 3; ++axis)
        if (v[axis] != 0.0f) end = std::min(end, (std::copysign(real(half_mm), v[axis]) - o[axis]) / v[axis]);
    return end;
}

/// Errors of a walk along random rays from random places.
template <class Walk>
WalkErrors errors_of(const std::vector<Site>& sites, int rays, std::uint64_t seed) {
    const CellData cells(sites, cube());
    const CellField field = cells.field();
    Draws draws(seed);
    WalkErrors errors;
    for (int n = 0; n < rays; ++n) {
        const Vec3 origin = to_vec3(draws.in_cube(half_mm)), direction = draws.direction();
        const real end = way_out_mm(origin, direction);
        const auto exact = exact_stretches(sites, origin, direction, double(end));
        const auto walked = walked_stretches(Walk(field, origin, direction), end);
        add_errors(sites, origin, direction, double(end), exact, walked, 0.01, errors);
    }
    return errors;
}

}  // namespace opal::cell_samples
