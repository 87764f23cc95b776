// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bsdf_sample.h"
#include "renderer/core/microfacet.h"

/// Metals. What light the surface lets in is absorbed at once.
namespace opal {

/// Unpolarized Fresnel reflectance of an absorber of complex index n + i k, relative to the index before it, at 0 <= cos <= 1
/// (Born & Wolf, section 14.2).
OPAL_HD inline real fresnel_conductor(real cos_incident, real n, real k) {
    const real cos2 = cos_incident * cos_incident, sin2 = 1.0f - cos2;
    const real difference = n * n - k * k - sin2;
    const real modulus = sqrt(square(difference) + square(2.0f * n * k));  // of the squared normal component beyond
    const real along = sqrt(max_of(0.0f, 0.5f * (modulus + difference)));
    const real cross = 2.0f * cos_incident * along;
    const real s = (modulus + cos2 - cross) / (modulus + cos2 + cross);
    const real sum = cos2 * modulus + sin2 * sin2;
    return 0.5f * s * (1.0f + (sum - cross * sin2) / (sum + cross * sin2));
}

/// A metal's surface at the wavelengths of a path.
template <int N>
struct Conductor {
    real roughness = 0.0f;  ///< GGX alpha; below min_roughness: a mirror
    real n[N], k[N];        ///< over the index before the surface
    int count = N;

    OPAL_HD bool smooth() const { return roughness < min_roughness; }

    /// What one of the small mirrors reflects; light that goes from mirror to mirror has no closed form. Directions are in a
    /// frame whose z is the normal on the path's side; `out` is where the path comes from.
    OPAL_HD BsdfValue<N> evaluate(Vec3 out, Vec3 in) const {
        BsdfValue<N> value;
        if (smooth() || !(out.z > 0.0f) || !(in.z > 0.0f)) return value;
        const Ggx ggx{roughness};
        const Vec3 half = normalize(out + in);
        const real cosine = dot(out, half);
        value.pdf = ggx.shadowing(out, in) * ggx.visible_density(out, half) / (4.0f * cosine);
        for (int i = 0; i < count; ++i) value.f_cosine.v[i] = value.pdf * fresnel_conductor(cosine, n[i], k[i]);
        return value;
    }

    /// A path that more than one mirror turned has pdf 0: nothing else draws its direction.
    template <class Random>
    OPAL_HD BsdfSample<N> sample(Vec3 out, Random& random) const {
        BsdfSample<N> sample;
        sample.ratio = Lanes<N>::all(1.0f);
        sample.weight = Lanes<N>::all(1.0f);
        if (smooth()) {
            for (int i = 0; i < count; ++i) sample.weight.v[i] = fresnel_conductor(min_of(1.0f, out.z), n[i], k[i]);
            sample.direction = {-out.x, -out.y, out.z};
            return sample;
        }
        const Ggx ggx{roughness};
        MicrofacetDepth depth;
        Vec3 direction = -out;
        bool first = true;
        for (depth.leaves(ggx, direction, random.next());; first = false) {
            const real u1 = random.next();
            const Vec3 half = ggx.sample_visible(-direction, u1, random.next());
            const real cosine = min_of(1.0f, max_of(0.0f, -dot(direction, half)));
            real largest = 0.0f;
            for (int i = 0; i < count; ++i) {
                sample.weight.v[i] *= fresnel_conductor(cosine, n[i], k[i]);
                largest = max_of(largest, sample.weight.v[i]);
            }
            direction = normalize(mirror(direction, half));
            if (!(largest > 0.0f)) return sample;
            if (depth.leaves(ggx, direction, random.next())) break;
        }
        sample.direction = direction;
        if (first) sample.pdf = evaluate(out, direction).pdf;
        return sample;
    }
};

}  // namespace opal
