// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "formats/image.h"
#include "formats/image_text.h"

namespace opal {

/// A white page that pictures for people are drawn on; positions in pixels from the upper left corner, colours display-encoded.
class PicturePage {
  public:
    PicturePage(int width, int height);

    Image& image() { return image_; }
    /// Lays a colour over a pixel, `coverage` of it in [0, 1]; does nothing beyond the page.
    void blend(int x, int y, const openvdb::Vec3f& color, double coverage = 1.0);
    /// Pixels x to x + width - 1, y to y + height - 1.
    void fill(int x, int y, int width, int height, const openvdb::Vec3f& color);
    /// One pixel wide, just outside of that rectangle.
    void frame(int x, int y, int width, int height, const openvdb::Vec3f& color);
    /// A disc around continuous coordinates (the first pixel's middle is 0.5), smooth at its rim.
    void disc(double x, double y, double radius, const openvdb::Vec3f& color, double coverage);
    /// See draw_text; where the font is missing, nothing is drawn.
    void text(int x, int y, const std::string& text, int height_px, TextAlign align);

  private:
    Image image_;
};

/// The largest of 1, 2 or 5 times a power of ten that is at most `length`, which is above 0.
double round_step(double length);

/// Multiples of a round step in [low, high], about `wanted` of them.
std::vector<double> round_ticks(double low, double high, int wanted);

}  // namespace opal
