// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_distance.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <optional>

namespace opal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Surface>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Surface to_surface(const TriangleMesh& mesh) {
    Surface surface;
    for (const openvdb::Vec3d& v : mesh.vertices_mm) surface.add_vertex(Point(v.x(), v.y(), v.z()));
    using Vertex = Surface::Vertex_index;
    for (const openvdb::Vec3I& t : mesh.triangles) surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
    return surface;
}

}  // namespace

struct MeshDistance::Search {
    Surface surface;
    Tree tree;
    std::optional<CGAL::Side_of_triangle_mesh<Surface, Kernel>> side;
};

MeshDistance::MeshDistance(const TriangleMesh& solid) : search_(std::make_unique<Search>()) {
    search_->surface = to_surface(solid);
    const auto faces = search_->surface.faces();
    search_->tree.insert(faces.begin(), faces.end(), search_->surface);
    // Built now, not on the first query: later queries come from many threads.
    search_->tree.build();
    search_->tree.accelerate_distance_queries();
    search_->side.emplace(search_->tree);
}

MeshDistance::~MeshDistance() = default;

double MeshDistance::distance_mm(const openvdb::Vec3d& point_mm) const {
    return std::sqrt(search_->tree.squared_distance(Point(point_mm.x(), point_mm.y(), point_mm.z())));
}

double MeshDistance::signed_distance_mm(const openvdb::Vec3d& point_mm) const {
    return contains(point_mm) ? -distance_mm(point_mm) : distance_mm(point_mm);
}

bool MeshDistance::contains(const openvdb::Vec3d& point_mm) const {
    return (*search_->side)(Point(point_mm.x(), point_mm.y(), point_mm.z())) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace opal
