// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

#include "formats/opal_asset.h"
#include "renderer/host/opal_surface.h"

namespace opal {
namespace {

TEST(OpalSurface, IsSmootherThanItsVoxels) {
    initialize_openvdb();
    const auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5.0f, openvdb::Vec3f(1.0f, 2.0f, 3.0f), 0.1f);
    const MeshData mesh = surface_from_level_set(*ball, "ball");
    ASSERT_FALSE(mesh.indices.empty());
    const Vec3 centre{1.0f, 2.0f, 3.0f};
    float largest_error = 0.0f, smallest_cosine = 1.0f;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 radial = mesh.positions[i] - centre;
        largest_error = std::max(largest_error, std::abs(length(radial) - 5.0f));
        smallest_cosine = std::min(smallest_cosine, dot(normalize(radial), mesh.normals[i]));
    }
    // Trilinear interpolation of the distance to a ball is too large by at most h^2 / (4 R): nothing else may be wrong.
    EXPECT_LT(largest_error, 0.1f * 0.1f / (4.0f * 5.0f) + 1e-5f);
    EXPECT_GT(smallest_cosine, 0.99999f);
    double volume = 0.0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const Vec3 a = mesh.positions[mesh.indices[t]] - centre, b = mesh.positions[mesh.indices[t + 1]] - centre,
                   c = mesh.positions[mesh.indices[t + 2]] - centre;
        volume += double(dot(a, cross(b, c))) / 6.0;
    }
    // Outward winding: positive; inscribed facets lose less than one part in a thousand.
    EXPECT_NEAR(volume, 4.0 / 3.0 * 3.14159265 * 125.0, 0.5);
}

}  // namespace
}  // namespace opal
