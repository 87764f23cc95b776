// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <utility>

#include "modeler/neighbour_graph.h"

namespace opal {

NeighbourGraph delaunay_graph(const std::vector<Site>& sites, const std::vector<char>& hidden) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::int32_t, Kernel>;
    using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
    using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

    std::vector<std::pair<Kernel::Point_3, std::int32_t>> points;
    for (std::size_t n = 0; n < sites.size(); ++n) {
        if (hidden[n] != 0) continue;
        const openvdb::Vec3d& p = sites[n].position_mm;
        points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), static_cast<std::int32_t>(n));
    }
    NeighbourGraph graph;
    if (points.size() < 2) return graph;
    const Delaunay delaunay(points.begin(), points.end());
    for (const auto& [cell, i, j] : delaunay.finite_edges()) {
        const std::int32_t a = cell->vertex(i)->info();
        const std::int32_t b = cell->vertex(j)->info();
        graph.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(graph.begin(), graph.end());
    return graph;
}

}  // namespace opal
