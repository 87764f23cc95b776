// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// Pixel reconstruction by filter importance sampling (Ernst et al. 2006): each sample's place is drawn from the filter itself
/// and counts fully, so that a pixel needs no weights and samples stay independent between pixels. All filters here are
/// separable, positive and normalized.
namespace opal {

enum class PixelFilterKind { tent, box, gaussian, blackman_harris };

/// A filter on [-radius, radius]^2 around the pixel's centre, in pixels.
struct PixelFilter {
    PixelFilterKind kind = PixelFilterKind::tent;
    real radius_px = 1.0f;
};

/// A Gaussian is cut at this many standard deviations.
inline constexpr real gaussian_filter_sigmas = 3.0f;

/// Coefficients of the four-term window of Harris 1978 ("On the use of windows for harmonic analysis with the discrete Fourier
/// transform", -92 dB), centred: w(x) = sum a_k cos(k pi x / radius).
OPAL_HD constexpr real blackman_harris_term(int k) {
    return k == 0 ? 0.35875f : (k == 1 ? 0.48829f : (k == 2 ? 0.14128f : 0.01168f));
}

/// Probability density (1/px) of one coordinate of a sample's offset from the pixel's centre.
OPAL_HD inline real pixel_filter_density(const PixelFilter& filter, real x_px) {
    const real t = fabs(x_px) / filter.radius_px;
    if (t > 1.0f) return 0.0f;
    switch (filter.kind) {
        case PixelFilterKind::tent:
            return (1.0f - t) / filter.radius_px;
        case PixelFilterKind::box:
            return 0.5f / filter.radius_px;
        case PixelFilterKind::gaussian: {
            const real s = gaussian_filter_sigmas * t;
            return gaussian_filter_sigmas * exp(-0.5f * s * s) /
                   (filter.radius_px * sqrt(2.0f * pi_f) * erf(gaussian_filter_sigmas * sqrt(0.5f)));
        }
        case PixelFilterKind::blackman_harris:
            break;
    }
    real sum = blackman_harris_term(0);
    for (int k = 1; k < 4; ++k) sum += blackman_harris_term(k) * cos(real(k) * pi_f * t);
    return sum / (2.0f * blackman_harris_term(0) * filter.radius_px);
}

/// Probability that |x| < t * radius.
OPAL_HD inline real pixel_filter_mass_within(PixelFilterKind kind, real t) {
    if (kind == PixelFilterKind::gaussian)
        return erf(gaussian_filter_sigmas * t * sqrt(0.5f)) / erf(gaussian_filter_sigmas * sqrt(0.5f));
    real sum = blackman_harris_term(0) * t;
    for (int k = 1; k < 4; ++k) sum += blackman_harris_term(k) * sin(real(k) * pi_f * t) / (real(k) * pi_f);
    return sum / blackman_harris_term(0);
}

/// The t in [0, 1] with that mass within it: Newton's method, kept inside a shrinking bracket. The density falls from the centre
/// outwards, so that the steps converge from below and need no more than a few rounds but at the very edge.
OPAL_HD inline real invert_pixel_filter_mass(const PixelFilter& filter, real mass) {
    real low = 0.0f, high = 1.0f, t = 0.5f * mass;
    for (int round = 0; round < 24; ++round) {
        const real excess = pixel_filter_mass_within(filter.kind, t) - mass;
        (excess > 0.0f ? high : low) = t;
        const real slope = 2.0f * filter.radius_px * pixel_filter_density(filter, t * filter.radius_px);
        real next = slope > 1.0e-6f ? t - excess / slope : low - 1.0f;
        if (!(next > low && next < high)) next = 0.5f * (low + high);
        const bool settled = fabs(next - t) < 1.0e-6f;
        t = next;
        if (settled) break;
    }
    return t;
}

/// Tent filter of radius one pixel by inversion.
OPAL_HD inline real sample_tent(real u) {
    return u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f - 2.0f * u);
}

/// One coordinate of a sample's offset from the pixel's centre (px), from a number in [0, 1): monotone, so that strata stay
/// strata.
OPAL_HD inline real sample_pixel_filter(const PixelFilter& filter, real u) {
    switch (filter.kind) {
        case PixelFilterKind::tent:
            return filter.radius_px * sample_tent(u);
        case PixelFilterKind::box:
            return filter.radius_px * (2.0f * u - 1.0f);
        default:
            break;
    }
    const real side = u < 0.5f ? -1.0f : 1.0f;
    return side * filter.radius_px * invert_pixel_filter_mass(filter, fabs(2.0f * u - 1.0f));
}

}  // namespace opal
