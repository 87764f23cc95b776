// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "modeler/cgal_surface.h"

namespace opal {

/// "(1, 2, 3) mm".
std::string describe_place(const cgal::Point& point_mm);

/// The first five places, and how many more there are.
std::string list_places(const std::vector<cgal::Point>& places_mm);

}  // namespace opal
