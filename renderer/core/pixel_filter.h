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
    float radius_px = 1.0f;
};

/// A Gaussian is cut at this many standard deviations.
inline constexpr float gaussian_filter_sigmas = 3.0f;

/// Coefficients of the four-term window of Harris 1978 ("On the use of windows for harmonic analysis with the discrete Fourier
/// transform", -92 dB), centred: w(x) = sum a_k cos(k pi x / radius).
OPAL_HD constexpr float blackman_harris_term(int k) {
    return k == 0 ? 0.35875f : (k == 1 ? 0.48829f : (k == 2 ? 0.14128f : 0.01168f));
}

/// Probability density (1/px) of one coordinate of a sample's offset from the pixel's centre.
OPAL_HD inline float pixel_filter_density(const PixelFilter& filter, float x_px) {
    const float t = fabsf(x_px) / filter.radius_px;
    if (t > 1.0f) return 0.0f;
    switch (filter.kind) {
        case PixelFilterKind::tent:
            return (1.0f - t) / filter.radius_px;
        case PixelFilterKind::box:
            return 0.5f / filter.radius_px;
        case PixelFilterKind::gaussian: {
            const float s = gaussian_filter_sigmas * t;
            return gaussian_filter_sigmas * expf(-0.5f * s * s) /
                   (filter.radius_px * sqrtf(2.0f * pi_f) * erff(gaussian_filter_sigmas * sqrtf(0.5f)));
        }
        case PixelFilterKind::blackman_harris:
            break;
    }
    float sum = blackman_harris_term(0);
    for (int k = 1; k < 4; ++k) sum += blackman_harris_term(k) * cosf(float(k) * pi_f * t);
    return sum / (2.0f * blackman_harris_term(0) * filter.radius_px);
}

/// Probability that |x| < t * radius.
OPAL_HD inline float pixel_filter_mass_within(PixelFilterKind kind, float t) {
    if (kind == PixelFilterKind::gaussian)
        return erff(gaussian_filter_sigmas * t * sqrtf(0.5f)) / erff(gaussian_filter_sigmas * sqrtf(0.5f));
    float sum = blackman_harris_term(0) * t;
    for (int k = 1; k < 4; ++k) sum += blackman_harris_term(k) * sinf(float(k) * pi_f * t) / (float(k) * pi_f);
    return sum / blackman_harris_term(0);
}

/// The t in [0, 1] with that mass within it: Newton's method, kept inside a shrinking bracket. The density falls from the centre
/// outwards, so that the steps converge from below and need no more than a few rounds but at the very edge.
OPAL_HD inline float invert_pixel_filter_mass(const PixelFilter& filter, float mass) {
    float low = 0.0f, high = 1.0f, t = 0.5f * mass;
    for (int round = 0; round < 24; ++round) {
        const float excess = pixel_filter_mass_within(filter.kind, t) - mass;
        (excess > 0.0f ? high : low) = t;
        const float slope = 2.0f * filter.radius_px * pixel_filter_density(filter, t * filter.radius_px);
        float next = slope > 1.0e-6f ? t - excess / slope : low - 1.0f;
        if (!(next > low && next < high)) next = 0.5f * (low + high);
        const bool settled = fabsf(next - t) < 1.0e-6f;
        t = next;
        if (settled) break;
    }
    return t;
}

/// Tent filter of radius one pixel by inversion.
OPAL_HD inline float sample_tent(float u) {
    return u < 0.5f ? sqrtf(2.0f * u) - 1.0f : 1.0f - sqrtf(2.0f - 2.0f * u);
}

/// One coordinate of a sample's offset from the pixel's centre (px), from a number in [0, 1): monotone, so that strata stay
/// strata.
OPAL_HD inline float sample_pixel_filter(const PixelFilter& filter, float u) {
    switch (filter.kind) {
        case PixelFilterKind::tent:
            return filter.radius_px * sample_tent(u);
        case PixelFilterKind::box:
            return filter.radius_px * (2.0f * u - 1.0f);
        default:
            break;
    }
    const float side = u < 0.5f ? -1.0f : 1.0f;
    return side * filter.radius_px * invert_pixel_filter_mass(filter, fabsf(2.0f * u - 1.0f));
}

}  // namespace opal
