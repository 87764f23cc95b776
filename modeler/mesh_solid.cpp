// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_solid.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "formats/error.h"
#include "modeler/cgal_surface.h"
#include "modeler/mesh_places.h"
#include "modeler/mesh_union.h"

namespace opal {
namespace {

using cgal::Point;
using cgal::Surface;
namespace processing = CGAL::Polygon_mesh_processing;

Surface join_triangles(const TriangleMesh& soup, const std::string& name) {
    std::vector<Point> points;
    for (const openvdb::Vec3d& v : soup.vertices_mm) points.emplace_back(v.x(), v.y(), v.z());
    std::vector<std::vector<std::size_t>> polygons;
    for (const openvdb::Vec3I& t : soup.triangles) polygons.push_back({t[0], t[1], t[2]});

    processing::repair_polygon_soup(points, polygons);
    processing::orient_polygon_soup(points, polygons);
    if (polygons.empty() || !processing::is_polygon_soup_a_polygon_mesh(polygons))
        throw InputError(fmt::format("mesh {}: its {} triangles do not form a surface", name, soup.triangles.size()));
    Surface surface;
    processing::polygon_soup_to_polygon_mesh(points, polygons, surface);
    processing::stitch_borders(surface);
    processing::remove_degenerate_faces(surface);
    return surface;
}

/// The middle of a hole's border.
Point middle_of_hole(const Surface& surface, Surface::Halfedge_index border) {
    openvdb::Vec3d sum(0.0);
    std::size_t vertices = 0;
    for (const auto vertex : CGAL::vertices_around_face(border, surface)) {
        const Point& p = surface.point(vertex);
        sum += openvdb::Vec3d(p.x(), p.y(), p.z());
        ++vertices;
    }
    sum /= static_cast<double>(vertices);
    return {sum.x(), sum.y(), sum.z()};
}

void require_closed(const Surface& surface, const std::string& name) {
    if (CGAL::is_closed(surface)) return;
    std::size_t border_edges = 0;
    for (const auto edge : surface.edges()) border_edges += surface.is_border(edge) ? 1 : 0;
    std::vector<Surface::Halfedge_index> holes;
    processing::extract_boundary_cycles(surface, std::back_inserter(holes));
    std::vector<Point> places;
    for (const auto hole : holes) places.push_back(middle_of_hole(surface, hole));
    throw InputError(fmt::format("mesh {}: is open, it must be closed: {} border edge{} around {} hole{} at {}", name,
                                 border_edges, border_edges == 1 ? "" : "s", holes.size(), holes.size() == 1 ? "" : "s",
                                 list_places(places)));
}

TriangleMesh to_triangles(const Surface& surface) {
    TriangleMesh mesh;
    std::vector<std::uint32_t> number(surface.number_of_vertices() + surface.number_of_removed_vertices());
    for (const auto vertex : surface.vertices()) {
        number[vertex] = static_cast<std::uint32_t>(mesh.vertices_mm.size());
        const Point& p = surface.point(vertex);
        mesh.vertices_mm.emplace_back(p.x(), p.y(), p.z());
    }
    for (const auto face : surface.faces()) {
        openvdb::Vec3I triangle;
        int corner = 0;
        for (const auto vertex : surface.vertices_around_face(surface.halfedge(face))) triangle[corner++] = number[vertex];
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

}  // namespace

TriangleMesh solid_from_triangles(const TriangleMesh& soup, const std::string& name) {
    Surface surface = join_triangles(soup, name);
    require_closed(surface, name);
    unite_crossing_parts(surface, name);
    processing::orient_to_bound_a_volume(surface);
    if (!(processing::volume(surface) > 0.0)) throw InputError(fmt::format("mesh {}: bounds no volume", name));
    return to_triangles(surface);
}

}  // namespace opal
