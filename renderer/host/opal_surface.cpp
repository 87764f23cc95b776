// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/opal_surface.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/parallel_for.h>

#include "formats/error.h"

namespace opal {
namespace {

using Sampler = openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler>;

/// Gradient by central differences over half a voxel of the trilinear field, averaged over one voxel's width.
openvdb::Vec3d gradient(const Sampler& sampler, const openvdb::Vec3d& world, double step_mm) {
    openvdb::Vec3d result;
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d offset(0.0);
        offset[axis] = step_mm;
        result[axis] = double(sampler.wsSample(world + offset)) - double(sampler.wsSample(world - offset));
    }
    return result / (2.0 * step_mm);
}

}  // namespace

MeshData surface_from_level_set(const openvdb::FloatGrid& shape, const std::string& file) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(shape, points, triangles, quads, 0.0, 0.0, true);
    if (triangles.empty() && quads.empty()) throw InputError(fmt::format("{}: grid shape: its level set has no surface", file));

    MeshData mesh;
    mesh.positions.resize(points.size());
    mesh.normals.resize(points.size());
    const double voxel_mm = shape.voxelSize().x();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const tbb::blocked_range<std::size_t>& range) {
        const auto accessor = shape.getConstAccessor();
        const Sampler sampler(accessor, shape.transform());
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            openvdb::Vec3d position = points[i];
            openvdb::Vec3d normal(0.0, 0.0, 1.0);
            for (int iteration = 0; iteration < 3; ++iteration) {
                const openvdb::Vec3d slope = gradient(sampler, position, voxel_mm);
                const double steepness2 = slope.lengthSqr();
                if (steepness2 < 1.0e-6) break;
                normal = slope / std::sqrt(steepness2);
                position -= (double(sampler.wsSample(position)) / std::sqrt(steepness2)) * normal;
            }
            mesh.positions[i] = {float(position.x()), float(position.y()), float(position.z())};
            mesh.normals[i] = {float(normal.x()), float(normal.y()), float(normal.z())};
        }
    });

    const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3 pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c];
        const Vec3 face = cross(pb - pa, pc - pa);
        if (!(dot(face, face) > 0.0f)) return;
        const bool outward = dot(face, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) >= 0.0f;
        mesh.indices.insert(mesh.indices.end(), {a, outward ? b : c, outward ? c : b});
    };
    for (const openvdb::Vec3I& t : triangles) add_triangle(t[0], t[1], t[2]);
    for (const openvdb::Vec4I& q : quads) {
        add_triangle(q[0], q[1], q[2]);
        add_triangle(q[0], q[2], q[3]);
    }
    return mesh;
}

}  // namespace opal
