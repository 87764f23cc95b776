// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_distance.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>

#include <optional>

#include "modeler/cgal_surface.h"

namespace opal {
namespace {

using cgal::Kernel;
using cgal::Surface;
using SideTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Surface>>>;

/// Distances need no exact predicates, which would cost several times as much; signs do.
using FastKernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<FastKernel::Triangle_3>;
using DistanceTree =
    CGAL::AABB_tree<CGAL::AABB_traits<FastKernel, CGAL::AABB_triangle_primitive<FastKernel, Triangles::const_iterator>>>;

Surface to_surface(const TriangleMesh& mesh) {
    Surface surface;
    for (const openvdb::Vec3d& v : mesh.vertices_mm) surface.add_vertex(cgal::Point(v.x(), v.y(), v.z()));
    using Vertex = Surface::Vertex_index;
    for (const openvdb::Vec3I& t : mesh.triangles) surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
    return surface;
}

Triangles to_triangles(const TriangleMesh& mesh) {
    const auto point = [&](std::uint32_t n) {
        const openvdb::Vec3d& v = mesh.vertices_mm[n];
        return FastKernel::Point_3(v.x(), v.y(), v.z());
    };
    Triangles triangles;
    for (const openvdb::Vec3I& t : mesh.triangles) triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    return triangles;
}

FastKernel::Point_3 to_fast(const openvdb::Vec3d& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace

struct MeshDistance::Search {
    Surface surface;
    SideTree side_tree;
    std::optional<CGAL::Side_of_triangle_mesh<Surface, Kernel>> side;
    Triangles triangles;
    DistanceTree distance_tree;
};

MeshDistance::MeshDistance(const TriangleMesh& solid) : search_(std::make_unique<Search>()) {
    search_->surface = to_surface(solid);
    const auto faces = search_->surface.faces();
    search_->side_tree.insert(faces.begin(), faces.end(), search_->surface);
    search_->triangles = to_triangles(solid);
    search_->distance_tree.insert(search_->triangles.cbegin(), search_->triangles.cend());
    // Built now, not on the first query: later queries come from many threads.
    search_->side_tree.build();
    search_->side.emplace(search_->side_tree);
    search_->distance_tree.build();
    search_->distance_tree.accelerate_distance_queries();
}

MeshDistance::~MeshDistance() = default;

openvdb::Vec3d MeshDistance::nearest_point_mm(const openvdb::Vec3d& point_mm) const {
    const auto nearest = search_->distance_tree.closest_point(to_fast(point_mm));
    return {nearest.x(), nearest.y(), nearest.z()};
}

openvdb::Vec3d MeshDistance::nearest_point_mm(const openvdb::Vec3d& point_mm, const openvdb::Vec3d& on_surface_mm) const {
    const auto nearest = search_->distance_tree.closest_point(to_fast(point_mm), to_fast(on_surface_mm));
    return {nearest.x(), nearest.y(), nearest.z()};
}

double MeshDistance::signed_distance_mm(const openvdb::Vec3d& point_mm) const {
    const double distance_mm = (nearest_point_mm(point_mm) - point_mm).length();
    return contains(point_mm) ? -distance_mm : distance_mm;
}

bool MeshDistance::contains(const openvdb::Vec3d& point_mm) const {
    return (*search_->side)(cgal::Point(point_mm.x(), point_mm.y(), point_mm.z())) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace opal
