// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/mesh_places.h"

#include <fmt/format.h>

namespace opal {
namespace {

constexpr std::size_t listed_places = 5;

}  // namespace

std::string describe_place(const cgal::Point& point_mm) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", point_mm.x(), point_mm.y(), point_mm.z());
}

std::string list_places(const std::vector<cgal::Point>& places_mm) {
    std::string text;
    for (std::size_t n = 0; n < places_mm.size() && n < listed_places; ++n)
        text += (n > 0 ? ", " : "") + describe_place(places_mm[n]);
    if (places_mm.size() > listed_places) text += fmt::format(" and {} more", places_mm.size() - listed_places);
    return text;
}

}  // namespace opal
