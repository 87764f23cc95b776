// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/alias_table.h"
#include "renderer/core/vec.h"

namespace opal {

/// Wavelengths that can travel together along one path: lane 0 is the hero, the others are its companions. The transport is
/// compiled for 1, 4 and 8 lanes.
inline constexpr int max_lanes = 8;
inline constexpr real spectrum_min_nm = 360.0f;
inline constexpr real spectrum_max_nm = 830.0f;
inline constexpr int spectrum_samples = 471;  ///< of tables in steps of 1 nm

/// One value per lane.
template <int N>
struct Lanes {
    real v[N] = {};

    OPAL_HD static Lanes all(real value) {
        Lanes lanes;
        for (int i = 0; i < N; ++i) lanes.v[i] = value;
        return lanes;
    }
};

struct Rgb {
    real r = 0.0f, g = 0.0f, b = 0.0f;
};

/// How colours become spectra: see upsampling.h.
enum class UpsamplingMethod { sigmoid, smits, basis };

/// Smits' spectra in one bin; `secondary[i]` lacks component i.
struct SmitsRow {
    float white = 0.0f;
    float secondary[3] = {};
    float primary[3] = {};
};
inline constexpr int smits_rows = 10;
inline constexpr real smits_first_nm = 380.0f;
inline constexpr real smits_bin_nm = 34.0f;

/// Tables over the wavelength, 360 to 830 nm in steps of 1 nm, but for Smits' ten bins.
struct SpectrumTables {
    const Vec3* observer = nullptr;   ///< CIE 1931 colour matching functions over the integral of y
    const float* white = nullptr;     ///< the environment's illuminant, scaled so that Y = 1
    const Vec3* rgb_basis = nullptr;  ///< reflectances of the sRGB primaries
    const float* pdf = nullptr;       ///< probability density of drawn wavelengths, 1/nm, constant within each nm
    const float* cdf = nullptr;       ///< its integral, 0 at 360 nm, 1 at 830 nm
    const SmitsRow* smits = nullptr;
    UpsamplingMethod upsampling = UpsamplingMethod::sigmoid;
    AliasTable alias;  ///< of the same density; empty where the hero is drawn by inversion
};

/// Linear interpolation in a 1 nm table; wavelengths are inside the range by construction.
template <typename T>
OPAL_HD inline auto table_at(const T* table, real wavelength_nm) {
    const real position = min_of(max_of(wavelength_nm - spectrum_min_nm, 0.0f), real(spectrum_samples - 1));
    const int i = min_of(int(position), spectrum_samples - 2);
    const real t = position - real(i);
    return (1.0f - t) * table[i] + t * table[i + 1];
}

/// The wavelengths of one path and their densities (1/nm).
template <int N>
struct PathWavelengths {
    real wavelength_nm[N];
    real pdf_per_nm[N];
    int count = N;  ///< lanes in use: 1 + companions
};

/// The 1 nm interval that holds a number in [0, 1) of the integrated density, and the place within it: inversion, monotone, so
/// that strata of numbers are strata of wavelengths.
OPAL_HD inline int invert_wavelength_density(const SpectrumTables& tables, real u, real& within) {
    int low = 0;
    for (int high = spectrum_samples - 1; high - low > 1;) {
        const int middle = (low + high) / 2;
        (tables.cdf[middle] <= u ? low : high) = middle;
    }
    within = (u - tables.cdf[low]) / (tables.cdf[low + 1] - tables.cdf[low]);
    return low;
}

/// Draws the hero from the table's density, by the alias table where there is one, else by inversion, and its companions by
/// rotating the hero's place in the integrated density (Wilkie et al. 2014, "Hero wavelength spectral sampling"), so that each
/// lane by itself has the table's density and all together are spread evenly over it. Lanes beyond `count` repeat others.
template <int N>
OPAL_HD inline PathWavelengths<N> sample_wavelengths(const SpectrumTables& tables, real u, int count) {
    PathWavelengths<N> result;
    result.count = count;
    const bool by_alias = tables.alias.count > 0;
    real within;
    int interval = by_alias ? tables.alias.sample(u, within) : invert_wavelength_density(tables, u, within);
    const real start = by_alias ? tables.cdf[interval] + within * tables.pdf[interval] : u;
    for (int lane = 0; lane < N; ++lane) {
        if (lane > 0) {
            const real turned = start + real(lane % count) / real(count);
            interval = invert_wavelength_density(tables, turned - floor(turned), within);
        }
        result.wavelength_nm[lane] = spectrum_min_nm + real(interval) + min_of(within, 0.999999f);
        result.pdf_per_nm[lane] = tables.pdf[interval];
    }
    return result;
}

/// Reflectance (or, times the white spectrum, radiance) of a linear sRGB colour: see formats/rgb_basis.h.
OPAL_HD inline real rgb_spectrum(const SpectrumTables& tables, Rgb color, real wavelength_nm) {
    const Vec3 basis = table_at(tables.rgb_basis, wavelength_nm);
    return color.r * basis.x + color.g * basis.y + color.b * basis.z;
}

}  // namespace opal
