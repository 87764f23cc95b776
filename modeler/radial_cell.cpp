// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/radial_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace opal {
namespace {

/// Heights that differ by less than this part of themselves are equal.
constexpr double height_tolerance = 1.0e-11;
/// Triangles of directions are halved no more often than this.
constexpr int max_halvings = 6;

using Triangle = std::array<openvdb::Vec3d, 3>;

/// Largest sum of the factors with which directions in the triangle are sums of its corners: 1 over the distance of the corners'
/// plane from the origin.
double kappa(const Triangle& corner) {
    const openvdb::Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double volume = corner[0].dot(normal), length = normal.length();
    return length > 1.0e-12 ? length / volume : 1.0;
}

/// slope.u + constant, on directions u.
struct AffineFunction {
    openvdb::Vec3d slope;
    double constant;

    double at(const openvdb::Vec3d& u) const { return slope.dot(u) + constant; }

    /// False only where it exceeds the tolerance nowhere in the triangle.
    bool may_be_positive(const Triangle& corner, double tolerance, int halvings) const {
        const double highest = std::max({at(corner[0]), at(corner[1]), at(corner[2])});
        if (highest > tolerance) return true;
        if (highest + std::max(0.0, -constant) * (kappa(corner) - 1.0) <= tolerance) return false;
        if (halvings == 0) return true;
        const openvdb::Vec3d middle[3] = {(corner[1] + corner[2]).unitSafe(), (corner[2] + corner[0]).unitSafe(),
                                          (corner[0] + corner[1]).unitSafe()};
        return may_be_positive({middle[0], middle[1], middle[2]}, tolerance, halvings - 1) ||
               may_be_positive({corner[0], middle[2], middle[1]}, tolerance, halvings - 1) ||
               may_be_positive({corner[1], middle[0], middle[2]}, tolerance, halvings - 1) ||
               may_be_positive({corner[2], middle[1], middle[0]}, tolerance, halvings - 1);
    }
};

}  // namespace

void SiteBlock::assign(const std::vector<Site>& sites, std::span<const std::int32_t> from) {
    index.assign(from.begin(), from.end());
    for (auto* list : {&x_mm, &y_mm, &z_mm, &weight_mm}) list->resize(from.size());
    for (std::size_t n = 0; n < from.size(); ++n) {
        const Site& site = sites[static_cast<std::size_t>(from[n])];
        x_mm[n] = site.position_mm.x();
        y_mm[n] = site.position_mm.y();
        z_mm[n] = site.position_mm.z();
        weight_mm[n] = static_cast<double>(site.weight_mm);
    }
}

const RadialCell::Faces& RadialCell::find_faces(const Site& site, std::int32_t self, const SiteBlock& block, double reach_mm) {
    position_mm_ = site.position_mm;
    weight_mm_ = static_cast<double>(site.weight_mm);
    reach_mm_ = reach_mm;
    faces_.proven.clear();
    faces_.undecided.clear();
    faces_.bounded = false;
    gather(self, block);
    if (clip() && order_polygons()) {
        prove_faces();
        rule_out_others();
    }
    return faces_;
}

std::span<const std::int32_t> RadialCell::rivals() const {
    return {index_.data(), num_rivals_};
}

void RadialCell::gather(std::int32_t self, const SiteBlock& block) {
    near_.clear();
    for (std::size_t n = 0; n < block.index.size(); ++n) {
        const double dx = block.x_mm[n] - position_mm_.x();
        const double dy = block.y_mm[n] - position_mm_.y();
        const double dz = block.z_mm[n] - position_mm_.z();
        const double squared_mm2 = dx * dx + dy * dy + dz * dz;
        // Rival and site are equally near at |s| / 2 - D / 2 at the least.
        const double limit_mm = 2.0 * reach_mm_ + (block.weight_mm[n] - weight_mm_) + tolerance_mm_;
        if (limit_mm > 0.0 && squared_mm2 <= limit_mm * limit_mm && block.index[n] != self)
            near_.push_back({std::sqrt(squared_mm2) - (block.weight_mm[n] - weight_mm_), static_cast<std::uint32_t>(n)});
    }
    std::sort(near_.begin(), near_.end());

    num_rivals_ = near_.size();
    index_.resize(num_rivals_);
    for (auto* list : {&sx_mm_, &sy_mm_, &sz_mm_, &lead_mm_, &power_mm2_, &allowance_mm_, &worst_}) list->resize(num_rivals_);
    for (auto* list : {&ax_, &ay_, &az_, &b_}) list->assign(num_rivals_ + num_box_planes, 0.0);
    for (std::size_t n = 0; n < num_rivals_; ++n) {
        const std::size_t from = near_[n].place;
        index_[n] = block.index[from];
        sx_mm_[n] = block.x_mm[from] - position_mm_.x();
        sy_mm_[n] = block.y_mm[from] - position_mm_.y();
        sz_mm_[n] = block.z_mm[from] - position_mm_.z();
        lead_mm_[n] = block.weight_mm[from] - weight_mm_;
        const double squared_mm2 = sx_mm_[n] * sx_mm_[n] + sy_mm_[n] * sy_mm_[n] + sz_mm_[n] * sz_mm_[n];
        power_mm2_[n] = squared_mm2 - lead_mm_[n] * lead_mm_[n];
        allowance_mm_[n] = std::sqrt(squared_mm2) + std::abs(lead_mm_[n]);
        const double factor = 2.0 / power_mm2_[n];
        ax_[n] = factor * sx_mm_[n];
        ay_[n] = factor * sy_mm_[n];
        az_[n] = factor * sz_mm_[n];
        b_[n] = factor * lead_mm_[n];
    }
    std::vector<double>* const axes[3] = {&ax_, &ay_, &az_};
    for (std::size_t plane = 0; plane < num_box_planes; ++plane)
        (*axes[plane / 2])[num_rivals_ + plane] = (plane % 2 == 0 ? 1.0 : -1.0) / reach_mm_;
}

bool RadialCell::clip() {
    for (auto* list : {&ux_, &uy_, &uz_, &height_}) list->clear();
    vertices_.clear();
    if (num_rivals_ > max_rivals) return false;
    // The corners of a box: one plane of each axis, in an order that turns the same way seen from outside.
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t x = num_rivals_ + (corner & 1), y = num_rivals_ + 2 + ((corner >> 1) & 1),
                          z = num_rivals_ + 4 + ((corner >> 2) & 1);
        const bool mirrored = ((corner & 1) ^ ((corner >> 1) & 1) ^ ((corner >> 2) & 1)) != 0;
        if (!(mirrored ? add_vertex(x, z, y) : add_vertex(x, y, z))) return false;
    }
    for (std::size_t rival = 0; rival < num_rivals_; ++rival) {
        const double lowest = *std::min_element(height_.begin(), height_.end());
        if (near_[rival].distance_mm * lowest > 2.0 * (1.0 + height_tolerance)) break;  // it matters only beyond all vertices
        if (!cut_off(rival)) return false;
    }
    return true;
}

bool RadialCell::cut_off(std::size_t rival) {
    std::size_t num_cut = 0;
    cut_.resize(vertices_.size());
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const bool cut = value(rival, v) > height_[v] * (1.0 + height_tolerance);
        cut_[v] = cut ? 1 : 0;
        num_cut += cut ? 1 : 0;
    }
    if (num_cut == 0) return true;
    if (num_cut == vertices_.size()) return false;

    edges_.clear();
    for (std::size_t v = 0; v < vertices_.size(); ++v)
        if (cut_[v] != 0)
            for (std::size_t n = 0; n < 3; ++n) edges_.push_back({vertices_[v].face[n], vertices_[v].face[(n + 1) % 3]});
    // An edge whose reverse is not there lies on the hole's rim; the rim must be one closed line.
    rim_.clear();
    for (const Edge& edge : edges_)
        if (std::find(edges_.begin(), edges_.end(), Edge{edge.to, edge.from}) == edges_.end()) rim_.push_back(edge);
    for (std::size_t n = 0; n + 1 < rim_.size(); ++n) {
        const auto next = std::find_if(rim_.begin() + static_cast<std::ptrdiff_t>(n) + 1, rim_.end(),
                                       [&](const Edge& edge) { return edge.from == rim_[n].to; });
        if (next == rim_.end()) return false;
        std::swap(rim_[n + 1], *next);
    }
    if (rim_.size() < 3 || rim_.back().to != rim_.front().from) return false;

    remove_cut_vertices();
    for (const Edge& edge : rim_)
        if (!add_vertex(rival, edge.from, edge.to)) return false;
    return vertices_.size() <= max_vertices;
}

void RadialCell::remove_cut_vertices() {
    std::size_t kept = 0;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        if (cut_[v] != 0) continue;
        vertices_[kept] = vertices_[v];
        ux_[kept] = ux_[v];
        uy_[kept] = uy_[v];
        uz_[kept] = uz_[v];
        height_[kept] = height_[v];
        ++kept;
    }
    vertices_.resize(kept);
    for (auto* list : {&ux_, &uy_, &uz_, &height_}) list->resize(kept);
}

bool RadialCell::add_vertex(std::size_t a, std::size_t b, std::size_t c) {
    // f_a = f_b = f_c is a line; of its two points on the sphere, the one where the three follow each other counterclockwise.
    const openvdb::Vec3d g(ax_[a] - ax_[b], ay_[a] - ay_[b], az_[a] - az_[b]);
    const openvdb::Vec3d h(ax_[a] - ax_[c], ay_[a] - ay_[c], az_[a] - az_[c]);
    const openvdb::Vec3d along = g.cross(h);
    const double squared = along.lengthSqr();
    if (!(squared > 0.0)) return false;
    const openvdb::Vec3d nearest = (h.cross(along) * (b_[b] - b_[a]) + along.cross(g) * (b_[c] - b_[a])) / squared;
    const double left = 1.0 - nearest.lengthSqr();
    if (!(left > 0.0)) return false;
    const openvdb::Vec3d u = (nearest + along * std::sqrt(left / squared)).unitSafe();
    const double height = ax_[a] * u.x() + ay_[a] * u.y() + az_[a] * u.z() + b_[a];
    if (!(height > 0.0)) return false;
    vertices_.push_back({{static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b), static_cast<std::uint16_t>(c)}});
    ux_.push_back(u.x());
    uy_.push_back(u.y());
    uz_.push_back(u.z());
    height_.push_back(height);
    return true;
}

bool RadialCell::order_polygons() {
    // A vertex (a, b, c) lies on the polygon of a between its edges with b and with c, and so on in turn.
    corners_.clear();
    for (std::size_t v = 0; v < vertices_.size(); ++v)
        for (std::size_t n = 0; n < 3; ++n)
            corners_.push_back({vertices_[v].face[n], vertices_[v].face[(n + 1) % 3], vertices_[v].face[(n + 2) % 3],
                                static_cast<std::uint16_t>(v)});
    std::sort(corners_.begin(), corners_.end());
    polygons_.clear();
    for (std::size_t first = 0, end = 0; first < corners_.size(); first = end) {
        while (end < corners_.size() && corners_[end].face == corners_[first].face) ++end;
        for (std::size_t n = first; n < end; ++n) {
            const std::size_t next = n + 1 < end ? n + 1 : first;
            const auto found = std::find_if(corners_.begin() + static_cast<std::ptrdiff_t>(next),
                                            corners_.begin() + static_cast<std::ptrdiff_t>(next == first ? first + 1 : end),
                                            [&](const Corner& corner) { return corner.before == corners_[n].after; });
            if (found == corners_.end() || found->face != corners_[first].face || found->before != corners_[n].after)
                return false;
            std::swap(corners_[next], *found);
        }
        polygons_.push_back({first, end, 1.0});
        if (!measure(polygons_.back())) return false;
    }
    return true;
}

bool RadialCell::measure(Polygon& polygon) const {
    const openvdb::Vec3d u = direction(corners_[polygon.first].vertex);
    for (std::size_t n = polygon.first + 1; n + 1 < polygon.end; ++n) {
        const Triangle triangle{u, direction(corners_[n].vertex), direction(corners_[n + 1].vertex)};
        // Triangles that all turn the same way and close up leave no gap on the sphere.
        if (!(u.dot(triangle[1].cross(triangle[2])) >= 0.0)) return false;
        polygon.kappa = std::max(polygon.kappa, kappa(triangle));
    }
    return true;
}

void RadialCell::prove_faces() {
    for (Polygon& polygon : polygons_) {
        const std::size_t face = corners_[polygon.first].face;
        if (face >= num_rivals_) continue;
        openvdb::Vec3d middle(0.0);
        for (std::size_t n = polygon.first; n < polygon.end; ++n) middle += direction(corners_[n].vertex);
        middle = middle.unitSafe();
        const double height = ax_[face] * middle.x() + ay_[face] * middle.y() + az_[face] * middle.z() + b_[face];
        if (height * reach_mm_ >= 1.0 && is_proof(face, middle, 1.0 / height)) {
            faces_.proven.push_back({index_[face], position_mm_ + middle / height});
            polygon.proven = true;
        }
    }
}

bool RadialCell::is_proof(std::size_t face, const openvdb::Vec3d& u, double distance_mm) {
    // delta_j - delta_i at x is |x - p_j| - (r + D) = (|s|^2 - D^2 - 2 r (u.s + D)) / (|x - p_j| + r + D).
    for (std::size_t n = 0; n < num_rivals_; ++n) {
        const double along_mm = u.x() * sx_mm_[n] + u.y() * sy_mm_[n] + u.z() * sz_mm_[n];
        const double numerator_mm2 = power_mm2_[n] - 2.0 * distance_mm * (along_mm + lead_mm_[n]);
        worst_[n] = numerator_mm2 - tolerance_mm_ * (2.0 * distance_mm + allowance_mm_[n]);
    }
    const double allowed_mm2 = tolerance_mm_ * distance_mm;
    const double own_mm2 = worst_[face] + tolerance_mm_ * (2.0 * distance_mm + allowance_mm_[face]);
    worst_[face] = std::numeric_limits<double>::infinity();
    return std::abs(own_mm2) <= allowed_mm2 && *std::min_element(worst_.begin(), worst_.end()) > 0.0;
}

void RadialCell::rule_out_others() {
    // First against the worst vertex and the worst polygon of all.
    std::fill(worst_.begin(), worst_.end(), -std::numeric_limits<double>::infinity());
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        const double x = ux_[v], y = uy_[v], z = uz_[v], height = height_[v] * (1.0 + height_tolerance);
        for (std::size_t n = 0; n < num_rivals_; ++n)
            worst_[n] = std::max(worst_[n], ax_[n] * x + ay_[n] * y + az_[n] * z + b_[n] - height);
    }
    double largest_kappa = 1.0, largest_b = -std::numeric_limits<double>::infinity();
    for (const Polygon& polygon : polygons_) {
        const std::size_t face = corners_[polygon.first].face;
        if (face >= num_rivals_) return;
        if (polygon.proven) worst_[face] = -std::numeric_limits<double>::infinity();
        largest_kappa = std::max(largest_kappa, polygon.kappa);
        largest_b = std::max(largest_b, b_[face]);
    }
    for (std::size_t n = 0; n < num_rivals_; ++n)
        if (worst_[n] + std::max(0.0, largest_b - b_[n]) * (largest_kappa - 1.0) > 0.0 &&
            may_lead({ax_[n], ay_[n], az_[n]}, b_[n]))
            faces_.undecided.push_back(index_[n]);
    faces_.bounded = !may_lead(openvdb::Vec3d(0.0), 1.0 / reach_mm_);
}

bool RadialCell::may_lead(const openvdb::Vec3d& a, double b) const {
    for (const Polygon& polygon : polygons_) {
        const std::size_t face = corners_[polygon.first].face;
        const AffineFunction excess{a - openvdb::Vec3d(ax_[face], ay_[face], az_[face]), b - b_[face]};
        const openvdb::Vec3d u = direction(corners_[polygon.first].vertex);
        for (std::size_t n = polygon.first + 1; n + 1 < polygon.end; ++n)
            if (excess.may_be_positive({u, direction(corners_[n].vertex), direction(corners_[n + 1].vertex)},
                                       height_tolerance * height_[corners_[polygon.first].vertex], max_halvings))
                return true;
    }
    return false;
}

}  // namespace opal
