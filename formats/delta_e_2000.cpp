// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "formats/colorimetry.h"

namespace opal {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Hue angle in [0, 2 pi); 0 for greys.
double hue_rad(double a, double b) {
    if (a == 0.0 && b == 0.0) return 0.0;
    const double hue = std::atan2(b, a);
    return hue < 0.0 ? hue + 2.0 * std::numbers::pi : hue;
}

double seventh_power_share(double chroma) {
    const double seventh = std::pow(chroma, 7.0);
    return std::sqrt(seventh / (seventh + std::pow(25.0, 7.0)));
}

}  // namespace

double delta_e_2000(const Lab& first, const Lab& second) {
    constexpr double pi = std::numbers::pi;
    const double mean_chroma_76 = 0.5 * (std::hypot(first.a, first.b) + std::hypot(second.a, second.b));
    const double stretch = 1.0 + 0.5 * (1.0 - seventh_power_share(mean_chroma_76));
    const double a1 = stretch * first.a, a2 = stretch * second.a;
    const double chroma1 = std::hypot(a1, first.b), chroma2 = std::hypot(a2, second.b);
    const double hue1 = hue_rad(a1, first.b), hue2 = hue_rad(a2, second.b);
    const bool grey = chroma1 * chroma2 == 0.0;

    double turn = grey ? 0.0 : hue2 - hue1;
    if (turn > pi) turn -= 2.0 * pi;
    if (turn < -pi) turn += 2.0 * pi;
    double mean_hue = hue1 + hue2;
    if (!grey) {
        if (std::abs(hue1 - hue2) > pi) mean_hue += mean_hue < 2.0 * pi ? 2.0 * pi : -2.0 * pi;
        mean_hue *= 0.5;
    }
    const double lightness = second.l - first.l, chroma = chroma2 - chroma1;
    const double hue = 2.0 * std::sqrt(chroma1 * chroma2) * std::sin(0.5 * turn);

    const double mean_chroma = 0.5 * (chroma1 + chroma2);
    const double from_middle = 0.5 * (first.l + second.l) - 50.0;
    const double weight = 1.0 - 0.17 * std::cos(mean_hue - 30.0 * degree) + 0.24 * std::cos(2.0 * mean_hue) +
                          0.32 * std::cos(3.0 * mean_hue + 6.0 * degree) - 0.20 * std::cos(4.0 * mean_hue - 63.0 * degree);
    const double lightness_scale = 1.0 + 0.015 * from_middle * from_middle / std::sqrt(20.0 + from_middle * from_middle);
    const double chroma_scale = 1.0 + 0.045 * mean_chroma;
    const double hue_scale = 1.0 + 0.015 * mean_chroma * weight;
    const double off_blue = (mean_hue / degree - 275.0) / 25.0;
    const double rotation = -std::sin(60.0 * degree * std::exp(-off_blue * off_blue)) * 2.0 * seventh_power_share(mean_chroma);
    const double l = lightness / lightness_scale, c = chroma / chroma_scale, h = hue / hue_scale;
    return std::sqrt(l * l + c * c + h * h + rotation * c * h);
}

}  // namespace opal
