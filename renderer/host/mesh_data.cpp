// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/mesh_data.h"

#include <cmath>

#include "formats/units.h"

namespace opal {
namespace {

/// A point of a profile that is turned about Z, with its outward normal in the (radius, z) plane.
struct ProfilePoint {
    double radius, z, normal_radius, normal_z;
};

MeshData revolve(const std::vector<ProfilePoint>& profile, int segments) {
    MeshData mesh;
    for (const ProfilePoint& point : profile)
        for (int s = 0; s < segments; ++s) {
            const double angle = 2.0 * units::pi * s / segments;
            const double c = std::cos(angle), n = std::sin(angle);
            mesh.positions.push_back({float(point.radius * c), float(point.radius * n), float(point.z)});
            mesh.normals.push_back({float(point.normal_radius * c), float(point.normal_radius * n), float(point.normal_z)});
        }
    for (std::uint32_t row = 0; row + 1 < profile.size(); ++row)
        for (int s = 0; s < segments; ++s) {
            const std::uint32_t a = row * segments + s, b = row * segments + (s + 1) % segments;
            const std::uint32_t c = a + segments, d = b + segments;
            if (profile[row].radius > 0.0) mesh.indices.insert(mesh.indices.end(), {a, c, b});
            if (profile[row + 1].radius > 0.0) mesh.indices.insert(mesh.indices.end(), {b, c, d});
        }
    return mesh;
}

}  // namespace

MeshData make_plane(double size_mm) {
    const float h = float(0.5 * size_mm);
    MeshData mesh;
    mesh.positions = {{-h, -h, 0.0f}, {h, -h, 0.0f}, {h, h, 0.0f}, {-h, h, 0.0f}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

MeshData make_sphere(double radius_mm) {
    constexpr int rows = 256, segments = 512;
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= rows; ++i) {
        const double theta = units::pi * i / rows;
        const double sine = i == rows ? 0.0 : std::sin(theta);
        profile.push_back({radius_mm * sine, radius_mm * std::cos(theta), sine, std::cos(theta)});
    }
    return revolve(profile, segments);
}

MeshData make_cylinder(double radius_mm, double height_mm, double bevel_mm) {
    constexpr int bevel_steps = 12, segments = 256;
    std::vector<ProfilePoint> profile = {{0.0, 0.0, 0.0, 1.0}};
    for (int i = 0; i <= bevel_steps; ++i) {
        const double angle = 0.5 * units::pi * i / bevel_steps;
        profile.push_back({radius_mm - bevel_mm + bevel_mm * std::sin(angle), -bevel_mm + bevel_mm * std::cos(angle),
                           std::sin(angle), std::cos(angle)});
    }
    profile.push_back({radius_mm, -height_mm, 1.0, 0.0});
    profile.push_back({radius_mm, -height_mm, 0.0, -1.0});
    profile.push_back({0.0, -height_mm, 0.0, -1.0});
    return revolve(profile, segments);
}

RigidTransform object_transform(const ObjectDescription& object) {
    const auto about = [](int axis, double angle_deg) {
        const double half = 0.5 * units::rad_from_deg(angle_deg);
        real v[3] = {0.0f, 0.0f, 0.0f};
        v[axis] = real(std::sin(half));
        return Quaternion{v[0], v[1], v[2], real(std::cos(half))};
    };
    const auto product = [](Quaternion a, Quaternion b) {
        return Quaternion{a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    };
    RigidTransform transform;
    transform.rotation =
        product(about(2, object.rotate_deg[2]), product(about(1, object.rotate_deg[1]), about(0, object.rotate_deg[0])));
    transform.origin = {real(object.translate_mm[0]), real(object.translate_mm[1]), real(object.translate_mm[2])};
    transform.scale = real(object.scale);
    return transform;
}

void transform_mesh(MeshData& mesh, const RigidTransform& world_from_object) {
    for (Vec3& position : mesh.positions) position = world_from_object.world_from_local_point(position);
    for (Vec3& normal : mesh.normals) normal = world_from_object.world_from_local_direction(normal);
}

}  // namespace opal
