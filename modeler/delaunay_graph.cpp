// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <utility>

#include "modeler/neighbour_graph.h"

namespace opal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::int32_t, Kernel>;
using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using NumberedPoint = std::pair<Kernel::Point_3, std::int32_t>;

NeighbourPair ascending(std::int32_t a, std::int32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// The visible sites at different places, the lowest where several share one. Those others become neighbours of the lowest,
/// which they are in the limit of sites that approach each other; CGAL would drop one of them, which one depends on its order.
std::vector<NumberedPoint> distinct_points(const std::vector<Site>& sites, const std::vector<char>& hidden,
                                           NeighbourGraph& graph) {
    std::vector<NumberedPoint> points;
    for (std::size_t n = 0; n < sites.size(); ++n) {
        if (hidden[n] != 0) continue;
        const openvdb::Vec3d& p = sites[n].position_mm;
        points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), static_cast<std::int32_t>(n));
    }
    tbb::parallel_sort(points.begin(), points.end());
    std::vector<NumberedPoint> distinct;
    distinct.reserve(points.size());
    for (const NumberedPoint& point : points) {
        if (!distinct.empty() && distinct.back().first == point.first)
            graph.push_back({distinct.back().second, point.second});
        else
            distinct.push_back(point);
    }
    return distinct;
}

void append_edges(const Delaunay& delaunay, NeighbourGraph& graph) {
    if (delaunay.dimension() < 3) {  // all on a line or in a plane: there are no cells
        for (const auto& [cell, i, j] : delaunay.finite_edges())
            graph.push_back(ascending(cell->vertex(i)->info(), cell->vertex(j)->info()));
        return;
    }
    graph.reserve(graph.size() + 6 * delaunay.number_of_finite_cells());
    for (const auto& cell : delaunay.finite_cell_handles())
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) graph.push_back(ascending(cell->vertex(i)->info(), cell->vertex(j)->info()));
}

}  // namespace

NeighbourGraph delaunay_graph(const std::vector<Site>& sites, const std::vector<char>& hidden) {
    NeighbourGraph graph;
    const std::vector<NumberedPoint> points = distinct_points(sites, hidden, graph);
    append_edges(Delaunay(points.begin(), points.end()), graph);
    tbb::parallel_sort(graph.begin(), graph.end());
    graph.erase(std::unique(graph.begin(), graph.end()), graph.end());
    graph.shrink_to_fit();
    return graph;
}

}  // namespace opal
