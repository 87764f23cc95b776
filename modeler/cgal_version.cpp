// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/cgal_version.h"

#include <CGAL/version.h>

namespace opal {

std::string cgal_version() {
    return CGAL_VERSION_STR;
}

}  // namespace opal
