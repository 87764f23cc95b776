// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

namespace opal {

/// Below this roughness a surface is smooth: a lobe narrower than a thousandth of a radian looks the same, and a float no longer
/// resolves its density.
inline constexpr real min_roughness = 1.0e-3f;

/// Rough surfaces as many small mirrors whose normals have the GGX distribution: Walter, Marschner, Li & Torrance 2007,
/// "Microfacet models for refraction through rough surfaces", section 5.2. All vectors are unit, in a frame whose z is the mean
/// normal; `v` points away from the mirrors and may point down, between them.
struct Ggx {
    real alpha;  ///< width of the distribution: slopes of the small mirrors, from min_roughness to 1

    /// Area of mirrors per area of the surface and solid angle of their normals: 1/sr.
    OPAL_HD real density(Vec3 normal) const {
        if (normal.z <= 0.0f) return 0.0f;
        const real slope2 = (square(normal.x) + square(normal.y)) / square(alpha);
        return 1.0f / (pi_f * square(alpha) * square(slope2 + square(normal.z)));
    }

    /// Smith's Lambda (Heitz 2014, "Understanding the masking-shadowing function in microfacet-based BRDFs", equation 72);
    /// carried on below the horizon, where it is at most -1 (Heitz, Hanika, d'Eon & Dachsbacher 2016, section 3).
    OPAL_HD real lambda(Vec3 v) const {
        const real x = square(alpha) * (square(v.x) + square(v.y)) / max_of(square(v.z), 1.0e-30f);
        const real above = 0.5f * x / (1.0f + sqrt(1.0f + x));
        return v.z >= 0.0f ? above : -1.0f - above;
    }

    /// Part of the mirrors that is seen from above along `a` and `b`, over the part seen along `a` (Heitz 2014, equation 99).
    OPAL_HD real shadowing(Vec3 a, Vec3 b) const {
        const real lambda_a = lambda(a);
        return (1.0f + lambda_a) / (1.0f + lambda_a + lambda(b));
    }

    /// The same for `b` below the surface: what is high on one side lies deep on the other (Heitz et al. 2016, section 6).
    OPAL_HD real shadowing_through(Vec3 a, Vec3 b) const {
        const double lambda_a = double(lambda(a)), lambda_b = double(lambda(-b));
        return real((1.0 + lambda_a) *
                    exp(log_gamma(1.0 + lambda_a) + log_gamma(1.0 + lambda_b) - log_gamma(2.0 + lambda_a + lambda_b)));
    }

    /// Density of the normals that are seen from `v`: 1/sr.
    OPAL_HD real visible_density(Vec3 v, Vec3 normal) const {
        return max_of(0.0f, dot(v, normal)) * density(normal) / (v.z * (1.0f + lambda(v)));
    }

    /// Draws a normal that is seen from `v` (Heitz 2018, "Sampling the GGX distribution of visible normals", by the equivalent
    /// spherical caps of Dupuy & Benyoub 2023).
    OPAL_HD Vec3 sample_visible(Vec3 v, real u1, real u2) const {
        const Vec3 stretched = normalize({alpha * v.x, alpha * v.y, v.z});
        const real z = (1.0f - u1) * (1.0f + stretched.z) - stretched.z;
        const real radius = sqrt(max_of(0.0f, 1.0f - z * z)), angle_rad = 2.0f * pi_f * u2;
        const Vec3 half = Vec3{radius * cos(angle_rad), radius * sin(angle_rad), z} + stretched;
        return normalize({alpha * half.x, alpha * half.y, max_of(half.z, 1.0e-7f)});
    }

  private:
    /// Natural logarithm of the gamma function from 1 up, to 1e-6: Stirling's series after three steps of the recurrence
    /// (Abramowitz & Stegun 1964, 6.1.15 and 6.1.41).
    OPAL_HD static double log_gamma(double x) {
        const double z = x + 3.0;
        return (z - 0.5) * log(z) - z + 0.91893853320467274 + 1.0 / (12.0 * z) - 1.0 / (360.0 * z * z * z) -
               log(x * (x + 1.0) * (x + 2.0));
    }
};

/// How deep between the small mirrors a path is: the part of the surface that lies lower. A path wanders from mirror to mirror
/// until it leaves (Heitz, Hanika, d'Eon & Dachsbacher 2016, "Multiple-scattering microfacet BSDFs with the Smith model", section
/// 5), so that rough surfaces lose no light.
struct MicrofacetDepth {
    real lower = 1.0f;

    /// Goes on along `direction` to the next mirror. Returns whether there is none: the path leaves.
    OPAL_HD bool leaves(const Ggx& ggx, Vec3 direction, real u) {
        const real lambda = ggx.lambda(direction);
        if (direction.z > 0.0f && !(u < 1.0f - pow(lower, lambda))) return true;
        lower = min_of(1.0f, max_of(shallowest, lower * pow(1.0f - u, -1.0f / lambda)));
        return false;
    }

    /// The same place seen from the other side of the surface.
    OPAL_HD void turn_over() { lower = max_of(shallowest, 1.0f - lower); }

  private:
    static constexpr real shallowest = 1.0e-12f;  ///< nobody gets out from 0
};

}  // namespace opal
