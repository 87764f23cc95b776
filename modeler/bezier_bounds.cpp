// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace opal {
namespace {

/// One coordinate of a patch's control points.
using Net = std::array<std::array<double, 4>, 4>;

Net transposed(const Net& net) {
    Net result;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) result[j][i] = net[i][j];
    return result;
}

/// De Casteljau's halving of every row.
std::pair<Net, Net> halve_rows(const Net& net) {
    std::pair<Net, Net> halves;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& [a, b, c, d] = net[i];
        const double ab = 0.5 * (a + b), bc = 0.5 * (b + c), cd = 0.5 * (c + d);
        const double abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd), middle = 0.5 * (abc + bcd);
        halves.first[i] = {a, ab, abc, middle};
        halves.second[i] = {middle, bcd, cd, d};
    }
    return halves;
}

double largest_corner(const Net& net) {
    return std::max({net[0][0], net[0][3], net[3][0], net[3][3]});
}

double largest_control(const Net& net) {
    double largest = net[0][0];
    for (const auto& row : net) largest = std::max(largest, *std::max_element(row.begin(), row.end()));
    return largest;
}

double largest_value(std::vector<Net> nets, double tolerance) {
    double reached = largest_corner(nets.front());
    while (!nets.empty()) {
        for (const Net& net : nets) reached = std::max(reached, largest_corner(net));
        std::vector<Net> halved;
        for (const Net& net : nets) {
            if (largest_control(net) <= reached + tolerance) continue;
            const auto [left, right] = halve_rows(net);
            for (const Net& half : {left, right}) {
                const auto [low, high] = halve_rows(transposed(half));
                halved.push_back(low);
                halved.push_back(high);
            }
        }
        nets = std::move(halved);
    }
    return reached;
}

}  // namespace

openvdb::BBoxd bezier_bounds_mm(const std::vector<BezierPatch>& patches) {
    openvdb::BBoxd hull;
    for (const BezierPatch& patch : patches)
        for (const auto& row : patch.control_mm)
            for (const auto& point : row) hull.expand(openvdb::Vec3d(point));
    const openvdb::Vec3d extents = hull.extents();
    const double tolerance = 1.0e-12 * std::max({extents.x(), extents.y(), extents.z()});

    openvdb::BBoxd bounds;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            std::vector<Net> nets(patches.size());
            for (std::size_t n = 0; n < patches.size(); ++n)
                for (std::size_t i = 0; i < 4; ++i)
                    for (std::size_t j = 0; j < 4; ++j) nets[n][i][j] = sign * patches[n].control_mm[i][j][axis];
            const double extreme = sign * largest_value(std::move(nets), tolerance);
            (sign < 0.0 ? bounds.min() : bounds.max())[axis] = extreme;
        }
    return bounds;
}

}  // namespace opal
