// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_shape.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <optional>

#include "formats/command.h"
#include "modeler/level_set.h"
#include "modeler/mesh_distance.h"
#include "modeler/mesh_file.h"
#include "modeler/mesh_solid.h"

namespace opal {
namespace {

/// Voxels by which the band is made wider at first, so that no voxel of the band itself is missed.
constexpr float spare_width = 1.0f;
/// Nearer to the surface than this (in voxels), a sign found in floats is not relied on: 2^20 voxels from the origin, where grids
/// end, a float is good to 1/16.
constexpr double uncertain_sign = 0.1;

class MeshShape final : public Shape {
  public:
    MeshShape(TriangleMesh solid, std::vector<BezierPatch> exact_surface)
        : solid_(std::move(solid)), exact_surface_(std::move(exact_surface)), distance_(solid_) {
        for (const openvdb::Vec3d& vertex_mm : solid_.vertices_mm) bounds_mm_.expand(vertex_mm);
    }

    double signed_distance_mm(const openvdb::Vec3d& point_mm) const override { return distance_.signed_distance_mm(point_mm); }
    bool contains(const openvdb::Vec3d& point_mm) const override { return distance_.contains(point_mm); }
    openvdb::BBoxd bounds_mm() const override { return bounds_mm_; }
    std::vector<BezierPatch> bezier_patches() const override { return exact_surface_; }

    openvdb::FloatGrid::Ptr level_set(double voxel_size_mm) const override {
        std::vector<openvdb::Vec3s> vertices_in_voxels;
        for (const openvdb::Vec3d& vertex_mm : solid_.vertices_mm) vertices_in_voxels.emplace_back(vertex_mm / voxel_size_mm);
        const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> adapter(vertices_in_voxels,
                                                                                                 solid_.triangles);
        const auto transform = openvdb::math::Transform::createLinearTransform(voxel_size_mm);
        const auto width = static_cast<float>(level_set_half_width) + spare_width;
        // This very signature is compiled into OpenVDB's library; any other takes minutes to compile under sanitizers.
        openvdb::util::NullInterrupter interrupter;
        const auto grid =
            openvdb::tools::meshToVolume<openvdb::FloatGrid>(interrupter, adapter, *transform, width, width, 0, nullptr);
        make_exact(grid->tree(), voxel_size_mm);
        label_as_shape(*grid, voxel_size_mm);
        return grid;
    }

  private:
    /// OpenVDB finds the band and its signs quickly, but works in floats and grows the band by passing on the nearest triangle of
    /// a neighbour, which may be the second nearest: off by up to a tenth of a voxel near edges. Distances, and signs next to the
    /// surface, are computed anew, and what the spare width holds beyond the band is dropped.
    void make_exact(openvdb::FloatTree& tree, double voxel_size_mm) const {
        const double band_mm = level_set_half_width * voxel_size_mm;
        openvdb::tree::LeafManager<openvdb::FloatTree> leaves(tree);
        leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
            if (interrupt_requested()) return;
            std::optional<openvdb::Vec3d> nearest_mm;
            for (auto value = leaf.beginValueOn(); value; ++value) {
                const openvdb::Vec3d point_mm = value.getCoord().asVec3d() * voxel_size_mm;
                // What is nearest to the voxel before is near to this one.
                nearest_mm =
                    nearest_mm ? distance_.nearest_point_mm(point_mm, *nearest_mm) : distance_.nearest_point_mm(point_mm);
                const double distance_mm = (*nearest_mm - point_mm).length();
                const bool inside = distance_mm < uncertain_sign * voxel_size_mm ? distance_.contains(point_mm) : *value < 0.0f;
                const double stored_mm = std::min(distance_mm, band_mm);
                value.setValue(static_cast<float>(inside ? -stored_mm : stored_mm));
                if (distance_mm >= band_mm) value.setValueOff();
            }
        });
        throw_if_interrupted();
        openvdb::tools::changeLevelSetBackground(tree, static_cast<float>(band_mm));
        openvdb::tools::pruneLevelSet(tree);
    }

    TriangleMesh solid_;
    std::vector<BezierPatch> exact_surface_;
    MeshDistance distance_;
    openvdb::BBoxd bounds_mm_;
};

}  // namespace

std::unique_ptr<Shape> make_mesh_shape(const std::filesystem::path& file, double mm_per_unit) {
    return make_solid_shape(solid_from_triangles(read_mesh_file(file, mm_per_unit), file.string()));
}

std::unique_ptr<Shape> make_solid_shape(TriangleMesh solid, std::vector<BezierPatch> exact_surface) {
    return std::make_unique<MeshShape>(std::move(solid), std::move(exact_surface));
}

}  // namespace opal
