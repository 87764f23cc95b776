// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/section_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "modeler/color_map.h"

namespace opal {
namespace {

const openvdb::Vec3f ink(0.1f), frame_grey(0.6f);
constexpr int key_oversampling = 4;

/// Without the negative zero that a tick can come to.
std::string number(double value) {
    return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value);
}

}  // namespace

void draw_axes(PicturePage& page, const PageRectangle& section, const SectionFrame& frame, int text_px) {
    static constexpr const char* names[] = {"x (mm)", "y (mm)", "z (mm)"};
    page.frame(section.x, section.y, section.width, section.height, frame_grey);
    const int tick_px = std::max(3, text_px / 3), gap_px = tick_px + text_px / 4;
    const int bottom = section.y + section.height;
    const double right_mm = frame.left_mm + frame.width * frame.pixel_mm,
                 bottom_mm = frame.top_mm - frame.height * frame.pixel_mm;
    for (const double tick_mm : round_ticks(frame.left_mm, right_mm, std::max(2, section.width / (5 * text_px)))) {
        const int x = section.x + static_cast<int>(std::floor((tick_mm - frame.left_mm) / frame.pixel_mm));
        page.fill(x, bottom, 1, tick_px, ink);
        page.text(x, bottom + gap_px + text_px / 2, number(tick_mm), text_px, TextAlign::center);
    }
    for (const double tick_mm : round_ticks(bottom_mm, frame.top_mm, std::max(2, section.height / (4 * text_px)))) {
        const int y = section.y + static_cast<int>(std::floor((frame.top_mm - tick_mm) / frame.pixel_mm));
        page.fill(section.x - tick_px, y, tick_px, 1, ink);
        page.text(section.x - gap_px, y, number(tick_mm), text_px, TextAlign::right);
    }
    page.text(section.x + section.width / 2, bottom + gap_px + 2 * text_px, names[frame.across], text_px, TextAlign::center);
    page.text(section.x - gap_px, section.y - text_px, names[frame.up], text_px, TextAlign::right);
}

void draw_scale_bar(PicturePage& page, int x, int y, int available_px, double pixel_mm, int text_px) {
    const double length_mm = round_step(0.25 * available_px * pixel_mm);
    const int length_px = static_cast<int>(std::lround(length_mm / pixel_mm)), thickness = std::max(2, text_px / 5);
    page.fill(x, y - thickness / 2, length_px, thickness, ink);
    page.text(x + length_px + text_px / 2, y, number(length_mm) + " mm", text_px, TextAlign::left);
}

void draw_color_bar(PicturePage& page, const PageRectangle& bar, double low, double high, int text_px) {
    for (int row = 0; row < bar.height; ++row)
        page.fill(bar.x, bar.y + row, bar.width, 1, viridis(1.0 - (row + 0.5) / bar.height));
    page.frame(bar.x, bar.y, bar.width, bar.height, frame_grey);
    const int tick_px = std::max(3, text_px / 3), right = bar.x + bar.width;
    if (!(high > low)) {
        page.text(right + tick_px, bar.y + bar.height / 2, number(low), text_px, TextAlign::left);
        return;
    }
    for (const double tick : round_ticks(low, high, std::max(2, bar.height / (4 * text_px)))) {
        const int y = bar.y + static_cast<int>(std::lround((high - tick) / (high - low) * (bar.height - 1)));
        page.fill(right, y, tick_px, 1, ink);
        page.text(right + tick_px + text_px / 4, y, number(tick), text_px, TextAlign::left);
    }
}

void draw_orientation_key(PicturePage& page, int x, int y, int size_px, int text_px) {
    // In stereographic projection [001] lies at (0, 0), [101] at (sqrt 2 - 1, 0), [111] at ((sqrt 3 - 1) / 2, (sqrt 3 - 1) / 2).
    const double width = std::sqrt(2.0) - 1.0, height = 0.5 * (std::sqrt(3.0) - 1.0), per_pixel = width / size_px;
    const int rows = static_cast<int>(std::ceil(height / per_pixel));
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column < size_px; ++column) {
            openvdb::Vec3f sum(0.0f);
            int inside = 0;
            for (int n = 0; n < key_oversampling * key_oversampling; ++n) {
                const double px = (column + (n % key_oversampling + 0.5) / key_oversampling) * per_pixel;
                const double py = (rows - row - (n / key_oversampling + 0.5) / key_oversampling) * per_pixel;
                const openvdb::Vec3d direction(2.0 * px, 2.0 * py, 1.0 - px * px - py * py);
                if (py < 0.0 || direction.y() > direction.x() || direction.x() > direction.z()) continue;
                sum += cubic_direction_color(direction);
                ++inside;
            }
            if (inside > 0)
                page.blend(x + column, y + row, sum / float(inside), double(inside) / (key_oversampling * key_oversampling));
        }
    page.text(x, y + rows + text_px, "001", text_px, TextAlign::center);
    page.text(x + size_px, y + rows + text_px, "101", text_px, TextAlign::center);
    page.text(x + static_cast<int>(height / per_pixel), y - text_px / 2, "111", text_px, TextAlign::center);
}

}  // namespace opal
