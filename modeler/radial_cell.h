// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// Sites near a place, coordinate by coordinate, for loops that compilers turn into vector code.
struct SiteBlock {
    std::vector<std::int32_t> index;
    std::vector<double> x_mm, y_mm, z_mm, weight_mm;

    void assign(const std::vector<Site>& sites, std::span<const std::int32_t> from);
};

/// The faces of one cell of an additively weighted diagram, seen from its site.
///
/// A cell is star-shaped about its site p_i. With s = p_j - p_i and D = w_j - w_i, the bisector with site j is met in direction u
/// (|u| = 1) at the distance r with 1 / r = f_j(u) = (2 s.u + 2 D) / (|s|^2 - D^2), a linear function plus a constant b_j. So the
/// cell ends in direction u at the largest f_j(u), and j has a face where f_j is the largest. Without weights that is the
/// polytope dual to the points 2 s / |s|^2; with them its edges bend on the sphere of directions.
///
/// The search clips a polytope by one rival after the other, nearest first, keeping each vertex as a direction in which three f_j
/// are equal. The result is only a guess at the faces; then
///  - a face counts on proof alone: a direction in the middle of it in which every other rival is farther;
///  - a rival is ruled out by the vertices: they cut the sphere into spherical polygons, each of one f_k, and a direction in one
///  of
///    its triangles is a sum of the corners with factors that add up to between 1 and kappa, so that f_j - f_k is at most the
///    largest value at the corners + max(0, b_k - b_j) (kappa - 1). Where that is not above 0 for any polygon, j has no face;
///  - what is neither proven nor ruled out is left undecided.
class RadialCell {
  public:
    struct Face {
        std::int32_t site;
        openvdb::Vec3d point_mm;  ///< where this cell meets the other's, all others being farther
    };
    struct Faces {
        std::vector<Face> proven;
        std::vector<std::int32_t> undecided;
        /// The cell ends within the reach in all directions, and sites in neither list have no face with it. Otherwise nothing is
        /// known about them, and `undecided` means nothing.
        bool bounded = false;
    };

    /// A rival that is nearer or farther by no more than the tolerance proves nothing.
    explicit RadialCell(double tolerance_mm) : tolerance_mm_(tolerance_mm) {}

    /// `block` holds all visible sites that may own a point within `reach_mm` of the site. The result is valid until the next
    /// call.
    const Faces& find_faces(const Site& site, std::int32_t self, const SiteBlock& block, double reach_mm);

    /// The sites, of the last call, that may own a point within the reach.
    std::span<const std::int32_t> rivals() const;

  private:
    static constexpr std::size_t max_rivals = 60'000;
    static constexpr std::size_t max_vertices = 500;
    static constexpr std::size_t num_box_planes = 6;

    /// A rival by the distance |s| - D; it owns nothing within half of that.
    struct Near {
        double distance_mm;
        std::uint32_t place;
        auto operator<=>(const Near&) const = default;
    };
    struct Vertex {
        std::array<std::uint16_t, 3> face;  ///< counterclockwise, seen from outside
    };
    struct Edge {
        std::uint16_t from, to;
        bool operator==(const Edge&) const = default;
    };
    /// A vertex as a corner of one of its faces, between the edges with two others.
    struct Corner {
        std::uint16_t face, before, after, vertex;
        auto operator<=>(const Corner&) const = default;
    };
    struct Polygon {
        std::size_t first, end;  ///< its corners in order
        double kappa;
        bool proven = false;
    };

    void gather(std::int32_t self, const SiteBlock& block);
    /// Each of these steps returns false where the polytope comes out inconsistent, by strong weights or by rounding.
    bool clip();
    bool cut_off(std::size_t rival);
    bool add_vertex(std::size_t a, std::size_t b, std::size_t c);
    bool order_polygons();
    bool measure(Polygon& polygon) const;
    void remove_cut_vertices();
    void prove_faces();
    bool is_proof(std::size_t face, const openvdb::Vec3d& u, double distance_mm);
    void rule_out_others();
    /// Whether a.u + b may be the largest somewhere.
    bool may_lead(const openvdb::Vec3d& a, double b) const;

    openvdb::Vec3d direction(std::size_t vertex) const { return {ux_[vertex], uy_[vertex], uz_[vertex]}; }
    double value(std::size_t rival, std::size_t vertex) const {
        return ax_[rival] * ux_[vertex] + ay_[rival] * uy_[vertex] + az_[rival] * uz_[vertex] + b_[rival];
    }

    double tolerance_mm_;
    double reach_mm_ = 0.0;
    openvdb::Vec3d position_mm_;
    double weight_mm_ = 0.0;
    Faces faces_;

    std::vector<Near> near_;
    /// Rivals in the order of `near_`: index, s, D, |s|^2 - D^2, |s| + |D|.
    std::size_t num_rivals_ = 0;
    std::vector<std::int32_t> index_;
    std::vector<double> sx_mm_, sy_mm_, sz_mm_, lead_mm_, power_mm2_, allowance_mm_;
    /// f(u) = a.u + b of the rivals, then of the planes of a box that keeps the polytope bounded.
    std::vector<double> ax_, ay_, az_, b_;
    std::vector<double> worst_;  ///< working memory, a number per rival

    std::vector<Vertex> vertices_;
    std::vector<double> ux_, uy_, uz_, height_;  ///< of the vertices: direction, and f there
    std::vector<char> cut_;
    std::vector<Edge> edges_, rim_;
    std::vector<Corner> corners_;
    std::vector<Polygon> polygons_;
};

}  // namespace opal
