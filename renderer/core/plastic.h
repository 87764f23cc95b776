// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bsdf_sample.h"
#include "renderer/core/fresnel.h"
#include "renderer/core/microfacet.h"

/// Plastic: a clear coat over a diffuse base.
namespace opal {

/// Fresnel reflectance of diffuse light that falls onto a body of relative index `eta`, weighted by the cosine: Walsh's closed
/// form (Duntley 1942, "The optical properties of diffusing materials"), below 1 by reversing the light's way.
OPAL_HD inline real mean_fresnel(real eta) {
    if (eta < 1.0f) return 1.0f - square(eta) * (1.0f - mean_fresnel(1.0f / eta));
    const double n = double(eta), n2 = n * n, n4 = n2 * n2;
    // Nearer to 1 the terms cancel; the value there is below 3e-4.
    if (n < 1.0005) return 0.0f;
    return real(0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
                n2 * (n2 - 1.0) * (n2 - 1.0) / ((n2 + 1.0) * (n2 + 1.0) * (n2 + 1.0)) * log((n - 1.0) / (n + 1.0)) -
                2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0)) +
                8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * log(n));
}

/// What a rough coat reflects by itself, over its index relative to what is before it and the square root of the cosine of the
/// incoming light: entries at equal steps from 0 to 1. Host: renderer/host/coat_albedo.h.
inline constexpr int coat_albedo_samples = 65;
struct CoatAlbedoView {
    const float* eta = nullptr;    ///< rising; between two of them values are interpolated
    const float* value = nullptr;  ///< coat_albedo_samples for each
    const float* mean = nullptr;   ///< weighted by the cosine, for each
    int count = 0;

    /// The last entry whose eta is not above, the first one at least; `part`: of the way to the next.
    OPAL_HD int row(real relative_index, real& part) const {
        int low = 0;
        for (int high = count - 1; high - low > 1;) {
            const int middle = (low + high) / 2;
            (eta[middle] <= relative_index ? low : high) = middle;
        }
        part = 0.0f;
        if (count > 1) part = max_of(0.0f, min_of(1.0f, (relative_index - eta[low]) / (eta[low + 1] - eta[low])));
        return low;
    }
    OPAL_HD real mean_at(real relative_index) const {
        real part;
        const int i = row(relative_index, part);
        return part > 0.0f ? mean[i] + part * (mean[i + 1] - mean[i]) : mean[i];
    }
    OPAL_HD real at(real relative_index, real cosine) const {
        real part;
        const int i = row(relative_index, part);
        const real place = sqrt(min_of(1.0f, cosine)) * real(coat_albedo_samples - 1);
        const int j = min_of(int(place), coat_albedo_samples - 2);
        const auto along = [&](const float* entry) { return entry[j] + (place - real(j)) * (entry[j + 1] - entry[j]); };
        const real low = along(value + i * coat_albedo_samples);
        return part > 0.0f ? low + part * (along(value + (i + 1) * coat_albedo_samples) - low) : low;
    }
};

/// Its surface at the wavelengths of a path. What the coat lets in is scattered by the base, turned back in part by the coat from
/// below, scattered again, and so on; with E(v) the part of light along v that the coat reflects at once (Fresnel's F where it is
/// smooth), summed up,
///   f_diffuse = (1 - E(out)) (1 - E(in)) a / (pi eta^2 (1 - a B)),  1 - B = (1 - mean E) / eta^2,
/// B the part that the coat reflects back down. With the coat's reflection a white base (a = 1) gives 1 in every direction.
template <int N>
struct Plastic {
    real roughness = 0.0f;       ///< GGX alpha of the coat; below min_roughness: smooth
    real eta[N];                 ///< index of the coat over the index before it
    real albedo[N];              ///< of the base
    CoatAlbedoView coat_albedo;  ///< E of a rough coat
    int count = N;

    OPAL_HD bool smooth() const { return roughness < min_roughness; }

    /// Directions in a frame whose z is the normal on the path's side; `out` is where the path comes from.
    OPAL_HD BsdfValue<N> evaluate(Vec3 out, Vec3 in) const {
        BsdfValue<N> value;
        if (!(out.z > 0.0f) || !(in.z > 0.0f)) return value;
        return evaluate(out, in, coat_chance(out));
    }

    template <class Random>
    OPAL_HD BsdfSample<N> sample(Vec3 out, Random& random) const {
        BsdfSample<N> sample;
        const real chance = coat_chance(out);
        sample.ratio = Lanes<N>::all(1.0f);
        const bool coat = random.next() < chance;
        const real u1 = random.next(), u2 = random.next();
        if (coat && smooth()) {
            real unused;
            for (int i = 0; i < count; ++i) sample.weight.v[i] = fresnel_dielectric(min_of(1.0f, out.z), eta[i], unused) / chance;
            sample.direction = {-out.x, -out.y, out.z};
            return sample;
        }
        Vec3 in;
        if (coat) {
            const Vec3 half = Ggx{roughness}.sample_visible(out, u1, u2);
            in = normalize(2.0f * dot(out, half) * half - out);
        } else {
            const real radius = sqrt(u1), angle_rad = 2.0f * pi_f * u2;
            in = normalize({radius * cos(angle_rad), radius * sin(angle_rad), sqrt(max_of(1.0e-12f, 1.0f - u1))});
        }
        if (!(in.z > 0.0f)) return sample;
        const BsdfValue<N> value = evaluate(out, in, chance);
        if (!(value.pdf > 0.0f)) return sample;
        for (int i = 0; i < count; ++i) sample.weight.v[i] = value.f_cosine.v[i] / value.pdf;
        sample.direction = in;
        sample.pdf = value.pdf;
        return sample;
    }

  private:
    OPAL_HD real reflectance(real cosine, int lane) const {
        real unused;
        return fresnel_dielectric(min_of(1.0f, cosine), eta[lane], unused);
    }

    /// E, see above.
    OPAL_HD real coat_reflectance(real cosine, int lane) const {
        return smooth() ? reflectance(cosine, lane) : coat_albedo.at(eta[lane], cosine);
    }

    /// Probability of choosing the coat: its part of what is sent back, the mean over the lanes. As it is the same whichever lane
    /// leads, so are the densities.
    OPAL_HD real coat_chance(Vec3 out) const {
        real coat = 0.0f, base = 0.0f;
        for (int i = 0; i < count; ++i) {
            const real f = coat_reflectance(out.z, i);
            coat += f;
            base += (1.0f - f) * albedo[i];
        }
        return coat + base > 0.0f ? coat / (coat + base) : 1.0f;
    }

    OPAL_HD BsdfValue<N> evaluate(Vec3 out, Vec3 in, real chance) const {
        BsdfValue<N> value;
        const real cosine_pdf = in.z / pi_f;
        value.pdf = (1.0f - chance) * cosine_pdf;
        const Vec3 half = normalize(out + in);
        const real cosine = dot(out, half);
        real coat = 0.0f;
        if (!smooth()) {
            const Ggx ggx{roughness};
            coat = ggx.shadowing(out, in) * ggx.visible_density(out, half) / (4.0f * cosine);
            value.pdf += chance * ggx.visible_density(out, half) / (4.0f * cosine);
        }
        for (int i = 0; i < count; ++i) {
            const real mean = smooth() ? mean_fresnel(eta[i]) : coat_albedo.mean_at(eta[i]);
            const real below = 1.0f - (1.0f - mean) / square(eta[i]);
            const real base = (1.0f - coat_reflectance(out.z, i)) * (1.0f - coat_reflectance(in.z, i)) * albedo[i] /
                              (square(eta[i]) * (1.0f - albedo[i] * below));
            value.f_cosine.v[i] = base * cosine_pdf + (smooth() ? 0.0f : coat * reflectance(cosine, i));
        }
        return value;
    }
};

}  // namespace opal
