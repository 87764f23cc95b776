// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "formats/image_text.h"

namespace opal {
namespace {

constexpr int gap_px = 4, label_px = 16;
constexpr float paper = 0.12f, ink = 0.8f;

/// Mean of a channel over the rectangle [x0, x1) x [y0, y1), parts of pixels counted as parts. Display values are averaged as
/// they are: tiles are for a glance.
float area_mean(const Image& image, double x0, double y0, double x1, double y1, int channel) {
    double sum = 0.0, area = 0.0;
    for (int y = int(y0); y < std::min<int>(image.height, int(std::ceil(y1))); ++y)
        for (int x = int(x0); x < std::min<int>(image.width, int(std::ceil(x1))); ++x) {
            const double share =
                (std::min(x1, x + 1.0) - std::max(x0, double(x))) * (std::min(y1, y + 1.0) - std::max(y0, double(y)));
            sum += share * double(image.pixel(x, y)[channel]);
            area += share;
        }
    return float(sum / area);
}

}  // namespace

ContactSheet::ContactSheet(int count, int picture_width, int picture_height, int tile_px) : count_(count) {
    const double scale = std::min(1.0, double(tile_px) / std::max(picture_width, picture_height));
    tile_width_ = std::max(1, int(std::lround(scale * picture_width)));
    tile_height_ = std::max(1, int(std::lround(scale * picture_height)));
    const double cell_aspect = double(tile_width_ + gap_px) / (tile_height_ + gap_px + label_px);
    // About four to three as a whole.
    columns_ = std::clamp(int(std::lround(std::sqrt(count * 4.0 / 3.0 / cell_aspect))), 1, count);
    const int rows = (count + columns_ - 1) / columns_;
    sheet_.width = columns_ * (tile_width_ + gap_px) + gap_px;
    sheet_.height = rows * (tile_height_ + gap_px + label_px) + gap_px;
    sheet_.channel_names = {"R", "G", "B"};
    sheet_.pixels.assign(std::size_t(sheet_.width) * sheet_.height * 3, paper);
}

void ContactSheet::add(const Image& display, const std::string& label) {
    if (used_ == count_) throw std::out_of_range("the contact sheet is full");
    const int left = gap_px + used_ % columns_ * (tile_width_ + gap_px);
    const int top = gap_px + used_ / columns_ * (tile_height_ + gap_px + label_px);
    const double step_x = double(display.width) / tile_width_, step_y = double(display.height) / tile_height_;
    for (int y = 0; y < tile_height_; ++y)
        for (int x = 0; x < tile_width_; ++x)
            for (int c = 0; c < 3; ++c)
                sheet_.pixel(left + x, top + y)[c] =
                    area_mean(display, x * step_x, y * step_y, (x + 1) * step_x, (y + 1) * step_y, c);
    TextStyle style;
    style.height_px = 12;
    style.align = TextAlign::center;
    style.color = {ink, ink, ink};
    draw_text(sheet_, left + tile_width_ / 2, top + tile_height_ + label_px / 2, label, style);
    ++used_;
}

}  // namespace opal
