// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "modeler/picture_page.h"
#include "modeler/section_raster.h"

namespace opal {

/// Where a picture lies on the page, in pixels.
struct PageRectangle {
    int x, y, width, height;
};

/// Frame, ticks and their lengths in mm to the left of and below a section, and the axes' names.
void draw_axes(PicturePage& page, const PageRectangle& section, const SectionFrame& frame, int text_px);

/// A bar of a round length, about a fifth of `available_px`, and that length in mm. (x, y): its left end, the line's middle.
void draw_scale_bar(PicturePage& page, int x, int y, int available_px, double pixel_mm, int text_px);

/// The colour map from `low` at the bottom to `high` at the top, with ticks.
void draw_color_bar(PicturePage& page, const PageRectangle& bar, double low, double high, int text_px);

/// The colours of cubic_direction_color over the standard triangle <100>, <110>, <111>, in stereographic projection.
void draw_orientation_key(PicturePage& page, int x, int y, int size_px, int text_px);

}  // namespace opal
