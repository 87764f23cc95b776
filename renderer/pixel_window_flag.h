// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/scene.h"

namespace opal {

/// "x0,y0,x1,y1" of the flag --crop. Throws InputError where it is not four whole numbers.
PixelWindow parse_pixel_window(const std::string& text);

}  // namespace opal
