// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/percolation_plot.h"

#include <fmt/format.h>
#include <plplot/plstream.h>

#include <algorithm>
#include <cmath>

namespace opal {
namespace {

constexpr int width_px = 1200, height_px = 780;
constexpr PLINT filled_circle = 17;

struct Color {
    PLINT index, red, green, blue;
};
constexpr Color paper{0, 255, 255, 255}, ink{1, 40, 40, 40}, grid{2, 225, 225, 225}, grains_color{3, 20, 95, 170},
    largest_color{4, 200, 75, 25}, threshold_color{5, 110, 110, 110};

/// The steep part of the curves fills the plot: some thresholds wide, and past the recipe's place.
double largest_p_shown(const PercolationPlot& plot) {
    const double wanted = std::max(3.0 * plot.curve.threshold.value_or(1.0), 1.25 * plot.marked_p.value_or(0.0));
    return std::clamp(std::ceil(20.0 * wanted) / 20.0, 0.05, 1.0);
}

class Canvas {
  public:
    Canvas(const PercolationPlot& plot, std::vector<unsigned char>& pixels)
        : plot_(plot), p_end_(largest_p_shown(plot)), pls_(1, 1) {
        pls_.sdev("memcairo");
        pls_.smem(width_px, height_px, pixels.data());
        for (const Color& color : {paper, ink, grid, grains_color, largest_color, threshold_color})
            pls_.scol0(color.index, color.red, color.green, color.blue);
        pls_.init();
        pls_.sfont(PL_FCI_SANS, PL_FCI_UPRIGHT, PL_FCI_MEDIUM);
        pls_.adv(0);
        pls_.vpor(0.09, 0.97, 0.12, 0.92);
        pls_.wind(0.0, p_end_, 0.0, 1.02);
    }

    void axes() {
        pls_.width(1.0);
        pls_.col0(grid.index);
        pls_.box("gt", 0.0, 0, "gt", 0.2, 0);
        pls_.col0(ink.index);
        pls_.schr(0.0, 0.85);
        pls_.box("bnst", 0.0, 0, "bnstv", 0.2, 2);
        pls_.schr(0.0, 0.95);
        pls_.mtex("b", 3.2, 0.5, 0.5, "bond probability p");
        pls_.mtex("l", 4.2, 0.5, 0.5, "fraction of the visible sites");
        pls_.mtex("t", 1.6, 0.5, 0.5, plot_.title.c_str());
    }

    void curve(const Color& color, const std::vector<double>& y) {
        std::vector<double> p;
        for (const PercolationPoint& point : plot_.curve.points) p.push_back(point.p);
        pls_.col0(color.index);
        pls_.width(3.0);
        pls_.line(static_cast<PLINT>(p.size()), p.data(), y.data());
        pls_.width(1.0);
        if (plot_.marked_p) mark(color, *plot_.marked_p, p, y);
    }

    void threshold() {
        if (!plot_.curve.threshold) return;
        const double p = *plot_.curve.threshold;
        pls_.col0(threshold_color.index);
        pls_.lsty(2);
        pls_.width(2.0);
        pls_.join(p, 0.0, p, 1.02);
        pls_.lsty(1);
        pls_.schr(0.0, 0.8);
        label(threshold_color, p + 0.012 * p_end_, 0.96, fmt::format("threshold {:.3g}", p));
    }

    void legend() {
        const double left = 0.66 * p_end_;
        legend_line(grains_color, left, 0.60, "grains per site, N(p) / sites");
        legend_line(largest_color, left, 0.53, "largest grain");
        if (!plot_.marked_p) return;
        pls_.col0(ink.index);
        const double x = left + 0.02 * p_end_, y = 0.46;
        symbol(x, y);
        label(ink, left + 0.055 * p_end_, y, fmt::format("this recipe, p = {:.3g}", *plot_.marked_p));
    }

  private:
    void mark(const Color& color, double at, const std::vector<double>& p, const std::vector<double>& y) {
        const auto after = std::upper_bound(p.begin() + 1, p.end() - 1, at) - p.begin();
        const auto n = static_cast<std::size_t>(after);
        const double t = (at - p[n - 1]) / (p[n] - p[n - 1]);
        pls_.col0(color.index);
        symbol(at, y[n - 1] + t * (y[n] - y[n - 1]));
    }
    void symbol(double x, double y) {
        pls_.ssym(0.0, 2.5);
        pls_.poin(1, &x, &y, filled_circle);
    }
    void label(const Color& color, double x, double y, const std::string& text) {
        pls_.col0(color.index);
        pls_.schr(0.0, 0.8);
        pls_.ptex(x, y, 1.0, 0.0, 0.0, text.c_str());
    }
    void legend_line(const Color& color, double left, double y, const std::string& text) {
        pls_.col0(color.index);
        pls_.width(3.0);
        pls_.join(left, y, left + 0.04 * p_end_, y);
        pls_.width(1.0);
        label(ink, left + 0.055 * p_end_, y, text);
    }

    const PercolationPlot& plot_;
    double p_end_;
    plstream pls_;
};

}  // namespace

Image draw_percolation_plot(const PercolationPlot& plot) {
    std::vector<double> grains, largest;
    for (const PercolationPoint& point : plot.curve.points) {
        grains.push_back(point.grains / static_cast<double>(std::max<std::size_t>(1, plot.num_visible)));
        largest.push_back(point.largest_fraction);
    }
    std::vector<unsigned char> pixels(static_cast<std::size_t>(width_px) * height_px * 3, 255);
    {
        Canvas canvas(plot, pixels);  // the picture is whole when it closes
        canvas.axes();
        canvas.threshold();
        canvas.curve(grains_color, grains);
        canvas.curve(largest_color, largest);
        canvas.legend();
    }
    Image image;
    image.width = width_px;
    image.height = height_px;
    image.channel_names = {"R", "G", "B"};
    image.pixels.assign(pixels.begin(), pixels.end());
    for (float& value : image.pixels) value /= 255.0f;
    return image;
}

}  // namespace opal
