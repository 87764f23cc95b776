// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "modeler/neighbour_graph.h"

namespace opal {

NeighbourGraph lattice_graph(const std::vector<openvdb::Coord>& cells, const std::vector<char>& hidden) {
    using NumberedCell = std::pair<openvdb::Coord, std::int32_t>;
    std::vector<NumberedCell> visible;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (hidden[n] == 0) visible.emplace_back(cells[n], static_cast<std::int32_t>(n));
    std::sort(visible.begin(), visible.end());

    NeighbourGraph graph;
    for (const auto& [cell, site] : visible)
        for (const openvdb::Coord& step : {openvdb::Coord(1, 0, 0), openvdb::Coord(0, 1, 0), openvdb::Coord(0, 0, 1)}) {
            const openvdb::Coord next = cell + step;
            const auto found = std::lower_bound(visible.begin(), visible.end(), NumberedCell(next, 0));
            if (found == visible.end() || found->first != next) continue;
            graph.push_back({std::min(site, found->second), std::max(site, found->second)});
        }
    std::sort(graph.begin(), graph.end());
    return graph;
}

}  // namespace opal
