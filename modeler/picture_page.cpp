// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/picture_page.h"

#include <algorithm>
#include <cmath>

namespace opal {

PicturePage::PicturePage(int width, int height) {
    image_.width = width;
    image_.height = height;
    image_.channel_names = {"R", "G", "B"};
    image_.pixels.assign(std::size_t(width) * std::size_t(height) * 3, 1.0f);
}

void PicturePage::blend(int x, int y, const openvdb::Vec3f& color, double coverage) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    float* const pixel = image_.pixel(x, y);
    const float part = static_cast<float>(std::clamp(coverage, 0.0, 1.0));
    for (int channel = 0; channel < 3; ++channel) pixel[channel] += part * (color[channel] - pixel[channel]);
}

void PicturePage::fill(int x, int y, int width, int height, const openvdb::Vec3f& color) {
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column) blend(column, row, color);
}

void PicturePage::frame(int x, int y, int width, int height, const openvdb::Vec3f& color) {
    fill(x - 1, y - 1, width + 2, 1, color);
    fill(x - 1, y + height, width + 2, 1, color);
    fill(x - 1, y, 1, height, color);
    fill(x + width, y, 1, height, color);
}

void PicturePage::disc(double x, double y, double radius, const openvdb::Vec3f& color, double coverage) {
    const int reach = static_cast<int>(std::ceil(radius)) + 1;
    const int middle_x = static_cast<int>(std::floor(x)), middle_y = static_cast<int>(std::floor(y));
    for (int row = middle_y - reach; row <= middle_y + reach; ++row)
        for (int column = middle_x - reach; column <= middle_x + reach; ++column) {
            const double inside = radius + 0.5 - std::hypot(column + 0.5 - x, row + 0.5 - y);
            if (inside > 0.0) blend(column, row, color, coverage * std::min(inside, 1.0));
        }
}

void PicturePage::text(int x, int y, const std::string& text, int height_px, TextAlign align) {
    TextStyle style;
    style.height_px = height_px;
    style.align = align;
    style.color = {0.1f, 0.1f, 0.1f};
    draw_text(image_, x, y, text, style);
}

double round_step(double length) {
    const double power = std::pow(10.0, std::floor(std::log10(length)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= length * (1.0 + 1.0e-12)) return factor * power;
    return power;
}

std::vector<double> round_ticks(double low, double high, int wanted) {
    std::vector<double> ticks;
    if (!(high > low)) return ticks;
    const double step = round_step((high - low) / std::max(1, wanted - 1));
    // A tick just beyond an end by rounding belongs to it.
    for (double n = std::ceil(low / step - 1.0e-9); n * step <= high + 1.0e-9 * step; ++n) ticks.push_back(n * step);
    return ticks;
}

}  // namespace opal
