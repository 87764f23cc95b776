// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_union.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/boost/graph/copy_face_graph.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "formats/error.h"
#include "modeler/mesh_places.h"
#include "modeler/union_find.h"

namespace opal {
namespace {

using cgal::Point;
using cgal::Surface;
namespace processing = CGAL::Polygon_mesh_processing;

using FacePair = std::pair<Surface::Face_index, Surface::Face_index>;
using PartOfFace = Surface::Property_map<Surface::Face_index, std::size_t>;

void require_parts_simple(const Surface& surface, const std::vector<FacePair>& crossings, const PartOfFace& part_of,
                          const std::string& name) {
    std::vector<Point> places;
    for (const auto& [a, b] : crossings)
        if (part_of[a] == part_of[b]) places.push_back(surface.point(surface.target(surface.halfedge(a))));
    if (places.empty()) return;
    throw InputError(fmt::format("mesh {}: intersects itself: {} pair{} of triangles of one part cross, near {}", name,
                                 places.size(), places.size() == 1 ? "" : "s", list_places(places)));
}

void face_outward(Surface& part) {
    if (!processing::is_outward_oriented(part)) processing::reverse_face_orientations(part);
}

}  // namespace

void unite_crossing_parts(Surface& surface, const std::string& name) {
    std::vector<FacePair> crossings;
    processing::self_intersections(surface, std::back_inserter(crossings));
    if (crossings.empty()) return;

    auto part_of = surface.add_property_map<Surface::Face_index, std::size_t>("f:part", 0).first;
    const std::size_t num_parts = processing::connected_components(surface, part_of);
    require_parts_simple(surface, crossings, part_of, name);

    UnionFind groups(num_parts);
    for (const auto& [a, b] : crossings) {
        const std::size_t group_a = groups.root(part_of[a]), group_b = groups.root(part_of[b]);
        if (group_a != group_b) groups.join(group_a, group_b);
    }
    std::vector<Surface> parts(num_parts);
    for (std::size_t n = 0; n < num_parts; ++n) {
        CGAL::Face_filtered_graph<Surface> filtered(surface, n, part_of);
        CGAL::copy_face_graph(filtered, parts[n]);
    }
    Surface united;
    for (std::size_t n = 0; n < num_parts; ++n) {
        if (groups.root(n) != n) continue;
        if (groups.size_at(n) > 1) face_outward(parts[n]);
        for (std::size_t other = 0; other < num_parts; ++other) {
            if (other == n || groups.root(other) != n) continue;
            face_outward(parts[other]);
            if (!processing::corefine_and_compute_union(parts[n], parts[other], parts[n]))
                throw InputError(fmt::format(
                    "mesh {}: its parts cross and cannot be united: the result would not be a surface; unite them in a modelling "
                    "program, or move parts that only touch apart",
                    name));
        }
        processing::remove_degenerate_faces(parts[n]);
        CGAL::copy_face_graph(parts[n], united);
    }
    surface = std::move(united);
}

}  // namespace opal
