// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "formats/image.h"

namespace opal {

/// Pixels of a picture whose R, G or B is NaN or infinite: another program's, or a damaged file's.
struct BrokenPixels {
    std::size_t count = 0;
    int x = 0, y = 0;  ///< the first, in pixels of the whole picture
};

/// None where all are finite.
std::optional<BrokenPixels> find_broken_pixels(const Image& image);

/// "FILE: 3 pixels are not finite numbers, the first at (5, 2)".
std::string describe(const BrokenPixels& broken, const std::string& file);

/// Sets R, G and B of such pixels to 0.
void blacken_broken_pixels(Image& image);

}  // namespace opal
