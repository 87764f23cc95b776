// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/bragg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/cie_tables.h"
#include "formats/colorimetry.h"
#include "formats/image_text.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr int plot_width = 720, plot_height = 480, left = 90, top = 60, right = 30, bottom = 80;
constexpr int text_px = 17, tick_px = 6;
constexpr std::array<float, 3> ink = {0.1f, 0.1f, 0.1f}, no_peak = {0.6f, 0.6f, 0.6f};
/// Colours whose strongest linear component is weaker than this, at the ends of the spectrum, fade in proportion.
constexpr double faintest_full_brightness = 0.1;

void fill(Image& image, int x, int y, int width, int height, const std::array<float, 3>& color) {
    for (int j = y; j < y + height; ++j)
        for (int i = x; i < x + width; ++i) std::copy(color.begin(), color.end(), image.pixel(i, j));
}

/// Multiples of 1, 2 or 5 times a power of ten in [low, high], at most about `wanted` of them.
std::vector<double> round_ticks(double low, double high, int wanted) {
    const double least = (high - low) / wanted, decade = std::pow(10.0, std::floor(std::log10(least)));
    double step = 10.0 * decade;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * decade >= least * (1.0 - 1.0e-9)) step = factor * decade;
    std::vector<double> ticks;
    for (double n = std::ceil(low / step - 1.0e-9); n * step <= high + 1.0e-9 * step; n += 1.0)
        ticks.push_back(n == 0.0 ? 0.0 : n * step);
    return ticks;
}

void draw_axes(Image& image, const BraggChart& chart) {
    fill(image, left, top + plot_height, plot_width, 1, ink);
    fill(image, left - 1, top, 1, plot_height + 1, ink);
    for (const double tick_nm : round_ticks(chart.diameter_min_nm, chart.diameter_max_nm, 10)) {
        const double part = (tick_nm - chart.diameter_min_nm) / (chart.diameter_max_nm - chart.diameter_min_nm);
        const int x = left + int(std::lround(part * (plot_width - 1)));
        fill(image, x, top + plot_height, 1, tick_px, ink);
        draw_text(image, x, top + plot_height + tick_px + text_px, fmt::format("{:.6g}", tick_nm),
                  {text_px, TextAlign::center, ink});
    }
    for (const double tick_deg : round_ticks(chart.angle_min_deg, chart.angle_max_deg, 8)) {
        const double part = (tick_deg - chart.angle_min_deg) / (chart.angle_max_deg - chart.angle_min_deg);
        const int y = top + plot_height - 1 - int(std::lround(part * (plot_height - 1)));
        fill(image, left - tick_px, y, tick_px, 1, ink);
        draw_text(image, left - tick_px - text_px / 3, y, fmt::format("{:.6g}", tick_deg), {text_px, TextAlign::right, ink});
    }
    draw_text(image, left + plot_width / 2, top + plot_height + tick_px + 3 * text_px, "sphere diameter (nm)",
              {text_px, TextAlign::center, ink});
    draw_text(image, left / 5, top - text_px, "angle in air (degrees)", {text_px, TextAlign::left, ink});
    draw_text(image, left + plot_width, top - text_px, chart.title, {text_px, TextAlign::right, ink});
}

}  // namespace

std::array<float, 3> spectral_display_color(double wavelength_nm) {
    const double place = std::clamp(wavelength_nm - colorimetric_min_nm, 0.0, double(cie_1931_observer.size() - 1));
    const std::size_t row = std::min<std::size_t>(std::size_t(place), cie_1931_observer.size() - 2);
    const double t = place - double(row);
    const CieObserverRow &low = cie_1931_observer[row], &high = cie_1931_observer[row + 1];
    const Rgb3d linear =
        linear_srgb_from_xyz({(1.0 - t) * double(low.x) + t * double(high.x), (1.0 - t) * double(low.y) + t * double(high.y),
                              (1.0 - t) * double(low.z) + t * double(high.z)});
    const double most = std::max({linear.r, linear.g, linear.b, faintest_full_brightness});
    const auto shown = [&](double component) { return float(srgb_encoded(std::max(0.0, component) / most)); };
    return {shown(linear.r), shown(linear.g), shown(linear.b)};
}

Image draw_bragg_chart(const BraggChart& chart) {
    Image image;
    image.width = left + plot_width + right;
    image.height = top + plot_height + bottom;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(std::size_t(image.width) * image.height * 3, 1.0f);
    CrystalOptics crystal = chart.crystal;
    for (int x = 0; x < plot_width; ++x) {
        crystal.sphere_diameter_nm =
            chart.diameter_min_nm + (chart.diameter_max_nm - chart.diameter_min_nm) * x / (plot_width - 1);
        for (int y = 0; y < plot_height; ++y) {
            const double angle_deg = chart.angle_max_deg - (chart.angle_max_deg - chart.angle_min_deg) * y / (plot_height - 1);
            const double wavelength_nm = bragg_wavelength_outside_nm(crystal, chart.planes, units::rad_from_deg(angle_deg));
            const bool visible = wavelength_nm >= chart_visible_min_nm && wavelength_nm <= chart_visible_max_nm;
            const std::array<float, 3> color = visible ? spectral_display_color(wavelength_nm) : no_peak;
            std::copy(color.begin(), color.end(), image.pixel(left + x, top + y));
        }
    }
    draw_axes(image, chart);
    return image;
}

}  // namespace opal
