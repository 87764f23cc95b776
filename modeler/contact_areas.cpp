// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/contact_areas.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "formats/command.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr int num_directions = 2048;

/// Evenly spread directions: points of a golden-angle spiral at equal steps of height.
std::vector<openvdb::Vec3d> spread_directions() {
    const double golden_angle_rad = units::pi * (3.0 - std::sqrt(5.0));
    std::vector<openvdb::Vec3d> directions;
    for (int n = 0; n < num_directions; ++n) {
        const double z = 1.0 - (2.0 * n + 1.0) / num_directions;
        const double radius = std::sqrt(1.0 - z * z);
        directions.emplace_back(radius * std::cos(golden_angle_rad * n), radius * std::sin(golden_angle_rad * n), z);
    }
    return directions;
}

/// A neighbour as its site sees it.
struct Rival {
    openvdb::Vec3d offset_mm;  ///< from the site
    double lead_mm;            ///< its weight less the site's
    double numerator_mm2;      ///< |s|^2 - D^2, above 0 for sites that own something
    std::size_t pair;
};

/// What each site sees of its faces; `area[pair]` of the graph's two ends, kept apart so that no two threads write one number.
class FaceView {
  public:
    FaceView(const NeighbourGraph& graph, const std::vector<Site>& sites, const Shape& shape)
        : sites_(sites), shape_(shape), rivals_(sites.size()), seen_by_first_(graph.size()), seen_by_second_(graph.size()) {
        for (std::size_t n = 0; n < graph.size(); ++n) {
            add_rival(graph[n].first, graph[n].second, n);
            add_rival(graph[n].second, graph[n].first, n);
        }
    }

    std::vector<double> measure(const NeighbourGraph& graph) {
        const std::vector<openvdb::Vec3d> directions = spread_directions();
        tbb::parallel_for(std::size_t(0), sites_.size(), [&](std::size_t site) {
            if (interrupt_requested()) return;
            for (const openvdb::Vec3d& direction : directions) look(site, direction, graph);
        });
        throw_if_interrupted();
        std::vector<double> areas_mm2(graph.size());
        for (std::size_t n = 0; n < graph.size(); ++n) areas_mm2[n] = 0.5 * (seen_by_first_[n] + seen_by_second_[n]);
        return areas_mm2;
    }

  private:
    void add_rival(std::int32_t of, std::int32_t rival, std::size_t pair) {
        const Site& site = sites_[static_cast<std::size_t>(of)];
        const Site& other = sites_[static_cast<std::size_t>(rival)];
        const openvdb::Vec3d offset_mm = other.position_mm - site.position_mm;
        const double lead_mm = static_cast<double>(other.weight_mm) - static_cast<double>(site.weight_mm);
        rivals_[static_cast<std::size_t>(of)].push_back({offset_mm, lead_mm, offset_mm.lengthSqr() - lead_mm * lead_mm, pair});
    }

    void look(std::size_t site, const openvdb::Vec3d& direction, const NeighbourGraph& graph) {
        const Rival* nearest = nullptr;
        double distance_mm = std::numeric_limits<double>::infinity();
        for (const Rival& rival : rivals_[site]) {
            const double approach_mm = direction.dot(rival.offset_mm) + rival.lead_mm;
            if (!(approach_mm > 0.0) || rival.numerator_mm2 >= 2.0 * approach_mm * distance_mm) continue;
            distance_mm = rival.numerator_mm2 / (2.0 * approach_mm);
            nearest = &rival;
        }
        if (!nearest || !shape_.contains(sites_[site].position_mm + distance_mm * direction)) return;
        const openvdb::Vec3d from_rival = (distance_mm * direction - nearest->offset_mm).unitSafe();
        const openvdb::Vec3d normal = (from_rival - direction).unitSafe();
        const double cosine = std::abs(normal.dot(direction));
        if (!(cosine > 0.0)) return;
        const double area_mm2 = distance_mm * distance_mm * (4.0 * units::pi / num_directions) / cosine;
        const bool is_first = static_cast<std::size_t>(graph[nearest->pair].first) == site;
        (is_first ? seen_by_first_ : seen_by_second_)[nearest->pair] += area_mm2;
    }

    const std::vector<Site>& sites_;
    const Shape& shape_;
    std::vector<std::vector<Rival>> rivals_;
    std::vector<double> seen_by_first_, seen_by_second_;
};

}  // namespace

std::vector<double> contact_areas_mm2(const NeighbourGraph& graph, const std::vector<Site>& sites, const Shape& shape) {
    return FaceView(graph, sites, shape).measure(graph);
}

}  // namespace opal
