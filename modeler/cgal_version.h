// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace opal {

/// Version of the CGAL that graphs and mesh repair are made with.
std::string cgal_version();

}  // namespace opal
