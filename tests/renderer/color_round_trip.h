// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/host/spectrum_tables.h"
#include "renderer/host/upsampler.h"

/// Colours through their spectra and back: shared by the tests and by opal-bench.
namespace opal {

using ReflectanceTable = std::array<double, colorimetric_samples>;

/// Colours of the sRGB cube, `steps` values per component, evenly spaced as they are encoded for display; linear.
inline std::vector<Rgb> srgb_cube(int steps) {
    std::vector<float> linear;
    for (int i = 0; i < steps; ++i) {
        const double encoded = double(i) / (steps - 1);
        linear.push_back(float(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4)));
    }
    std::vector<Rgb> colors;
    for (const float r : linear)
        for (const float g : linear)
            for (const float b : linear) colors.push_back({r, g, b});
    return colors;
}

/// The spectrum that a renderer with `tables` gives a colour of reflectance.
inline ReflectanceTable reflectance_table(const SpectrumTablesData& tables, Rgb color) {
    const UpsampledColor upsampled_color = upsample_reflectance(tables.upsampling, color);
    ReflectanceTable reflectance;
    for (std::size_t i = 0; i < reflectance.size(); ++i)
        reflectance[i] = double(upsampled(tables.view(), upsampled_color, 360.0f + float(i)));
    return reflectance;
}

/// CIE Lab of linear sRGB, and of a reflectance under the tables' light; white is D65.
inline Lab lab_of(Rgb3d color) {
    return lab_from_xyz(xyz_from_linear_srgb(color), srgb_white);
}
inline Lab lab_of(const SpectrumTablesData& tables, const ReflectanceTable& reflectance) {
    ReflectanceTable light;
    std::copy(tables.white.begin(), tables.white.end(), light.begin());
    return lab_from_xyz(xyz_of_product(reflectance, light), srgb_white);
}

/// Mean, 95th percentile and largest of some errors.
struct ErrorStatistics {
    double mean = 0.0, percentile_95 = 0.0, max = 0.0;
};
inline ErrorStatistics statistics_of(std::vector<double> errors) {
    ErrorStatistics statistics;
    for (const double error : errors) statistics.mean += error / double(errors.size());
    std::sort(errors.begin(), errors.end());
    statistics.percentile_95 = errors[(errors.size() - 1) * 95 / 100];
    statistics.max = errors.back();
    return statistics;
}

}  // namespace opal
