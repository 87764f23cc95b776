// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "modeler/boundary_noise.h"
#include "modeler/labelling.h"
#include "modeler/shape.h"
#include "modeler/tessellation_metric.h"
#include "modeler_test_tools.h"

namespace opal::testing_tools {

inline std::unique_ptr<Shape> shape_of(ShapeKind kind, std::array<double, 3> size_mm) {
    ShapeRecipe recipe;
    recipe.kind = kind;
    recipe.size_mm = size_mm;
    recipe.girdle_mm = 0.2 * size_mm[2];
    return make_shape(recipe);
}

/// Every site a grain of its own.
inline std::vector<std::int32_t> one_label_each(const std::vector<Site>& sites) {
    std::vector<std::int32_t> labels(sites.size());
    std::iota(labels.begin(), labels.end(), 1);
    return labels;
}

/// The site that a search through all of them finds, lowest index first.
inline std::int32_t searched_owner(const openvdb::Vec3d& x, const std::vector<Site>& sites,
                                   const std::vector<std::int32_t>& labels, TessellationKind kind) {
    return with_metric(kind, [&](auto metric) {
        double smallest = std::numeric_limits<double>::infinity();
        std::int32_t owner = 0;
        for (std::size_t n = 0; n < sites.size(); ++n) {
            const double delta = metric.delta_mm(x, sites[n]);
            if (labels[n] != 0 && delta < smallest) smallest = delta, owner = labels[n];
        }
        return owner;
    });
}

/// The labels of all voxels against that search, and the form of the grid.
inline void expect_searched_labels(const openvdb::Int32Grid& grid, const openvdb::FloatGrid& shape,
                                   const std::vector<Site>& sites, const std::vector<std::int32_t>& labels,
                                   const Tessellation& tessellation = {}) {
    openvdb::CoordBBox box;
    ASSERT_TRUE(shape.tree().evalLeafBoundingBox(box));
    const double h = shape.voxelSize().x();
    const openvdb::BBoxd bounds(box.min().asVec3d() * h, box.max().asVec3d() * h);
    const BoundaryNoise noise(tessellation.boundary_noise, tessellation.seed, bounds);
    auto distances = shape.getConstAccessor();
    auto values = grid.getConstAccessor();
    std::uint64_t inside = 0;
    for (const openvdb::Coord& voxel : box) {
        const bool is_inside = distances.getValue(voxel) < 0.0f;
        inside += is_inside ? 1 : 0;
        ASSERT_EQ(values.isValueOn(voxel), is_inside) << voxel;
        openvdb::Vec3d x = voxel.asVec3d() * h;
        if (is_inside && noise.amplitude_mm() > 0.0) x = noise.displaced(x);
        ASSERT_EQ(values.getValue(voxel), is_inside ? searched_owner(x, sites, labels, tessellation.kind) : 0) << voxel;
    }
    EXPECT_EQ(grid.activeVoxelCount(), inside);
    EXPECT_EQ(grid.background(), 0);
    EXPECT_GE(grid.tree().leafCount(), 1u);
}

}  // namespace opal::testing_tools
