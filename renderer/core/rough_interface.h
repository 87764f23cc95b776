// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bsdf_sample.h"
#include "renderer/core/fresnel.h"
#include "renderer/core/microfacet.h"

namespace opal {

/// A rough surface between two transparent bodies (Walter et al. 2007, sections 4 and 5), for radiance over the squared index,
/// which is what paths carry here: smooth surfaces pass it on unscaled too, and f has the index of the side of the sampled
/// direction in the place of the other's (Veach 1997, section 5.2). No light is lost.
///
/// All lanes share the drawn directions. A mirror reflects all alike; to refract so, each lane needs a mirror of its own tilt,
/// and the ratio of the densities follows from those tilts.
template <int N>
struct RoughInterface {
    real roughness;  ///< GGX alpha, from min_roughness
    real eta[N];     ///< index beyond over index before
    int count = N;

    /// What one of the small mirrors reflects or lets through; light that goes from mirror to mirror has no closed form.
    /// Directions are in a frame whose z is the normal on the path's side; `out` is where the path comes from.
    OPAL_HD BsdfValue<N> evaluate(Vec3 out, Vec3 in) const {
        BsdfValue<N> value;
        if (!(out.z > 0.0f) || in.z == 0.0f || matched(0)) return value;
        const Ggx ggx{roughness};
        const bool passes = in.z < 0.0f;
        const real seen = passes ? ggx.shadowing_through(out, in) : ggx.shadowing(out, in);
        for (int i = 0; i < count; ++i) value.f_cosine.v[i] = seen * turn_density(ggx, out, in, passes, eta[i]);
        value.pdf = value.f_cosine.v[0];
        return value;
    }

    /// A path that more than one mirror turned has pdf 0: nothing else draws its direction.
    template <class Random>
    OPAL_HD BsdfSample<N> sample(Vec3 out, Random& random) const {
        if (matched(0)) return passed(out);
        BsdfSample<N> sample;
        sample.weight = Lanes<N>::all(1.0f);
        sample.ratio = Lanes<N>::all(1.0f);
        const Ggx ggx{roughness};
        MicrofacetDepth depth;
        Vec3 direction = -out;  // in the frame of the side where the path is
        bool first = true;
        for (depth.leaves(ggx, direction, random.next());; first = false) {
            const real relative = sample.transmitted ? 1.0f / eta[0] : eta[0];
            const real u1 = random.next();
            const Vec3 half = ggx.sample_visible(-direction, u1, random.next());
            const real cosine = min_of(1.0f, max_of(0.0f, -dot(direction, half)));
            real cos_refracted;
            const bool passes = !(random.next() < fresnel_dielectric(cosine, relative, cos_refracted));
            const Vec3 turned =
                passes ? refract(direction, half, relative, cosine, cos_refracted) : normalize(mirror(direction, half));
            weigh_lanes(ggx, -direction, turned, passes, sample);
            direction = turned;
            if (passes) {
                direction.z = -direction.z;
                depth.turn_over();
                sample.transmitted = !sample.transmitted;
            }
            if (depth.leaves(ggx, direction, random.next())) break;
        }
        sample.direction = {direction.x, direction.y, sample.transmitted ? -direction.z : direction.z};
        if (first) sample.pdf = evaluate(out, sample.direction).pdf;
        return sample;
    }

  private:
    /// Indices so near each other that light goes straight on: it would be turned by less than its lobe is resolved.
    OPAL_HD bool matched(int lane) const { return fabs(eta[lane] - 1.0f) < 1.0e-4f; }

    OPAL_HD BsdfSample<N> passed(Vec3 out) const {
        BsdfSample<N> sample;
        sample.direction = -out;
        sample.transmitted = true;
        sample.weight = Lanes<N>::all(1.0f);
        for (int i = 0; i < count; ++i) sample.ratio.v[i] = matched(i) ? 1.0f : 0.0f;
        return sample;
    }

    OPAL_HD void weigh_lanes(const Ggx& ggx, Vec3 back, Vec3 turned, bool passes, BsdfSample<N>& sample) const {
        bool same = true;
        for (int i = 1; i < count; ++i) same = same && eta[i] == eta[0];
        if (same) return;
        const bool beyond = sample.transmitted;
        const real hero = turn_density(ggx, back, turned, passes, beyond ? 1.0f / eta[0] : eta[0]);
        for (int i = 1; i < count; ++i)
            sample.ratio.v[i] *=
                hero > 0.0f ? turn_density(ggx, back, turned, passes, beyond ? 1.0f / eta[i] : eta[i]) / hero : 0.0f;
    }

    /// Density (1/sr) of the directions into which mirrors seen from `out` turn the light.
    OPAL_HD static real turn_density(const Ggx& ggx, Vec3 out, Vec3 in, bool passes, real relative) {
        return passes ? refracted_density(ggx, out, in, relative) : reflected_density(ggx, out, in, relative);
    }

    OPAL_HD static real reflected_density(const Ggx& ggx, Vec3 out, Vec3 in, real relative) {
        const Vec3 half = normalize(out + in);
        const real cosine = dot(out, half);
        if (!(cosine > 0.0f)) return 0.0f;
        real unused;
        return fresnel_dielectric(cosine, relative, unused) * ggx.visible_density(out, half) / (4.0f * cosine);
    }

    /// Walter et al. 2007, equation 17, for the solid angle of the refracted directions.
    OPAL_HD static real refracted_density(const Ggx& ggx, Vec3 out, Vec3 in, real relative) {
        const Vec3 sum = out + relative * in;
        const real sum_length = length(sum);
        if (!(sum_length > 0.0f)) return 0.0f;
        const Vec3 half = (sum.z > 0.0f ? 1.0f : -1.0f) / sum_length * sum;
        const real cos_out = dot(out, half), cos_in = dot(in, half);
        if (!(cos_out > 0.0f) || !(cos_in < 0.0f)) return 0.0f;
        real unused;
        const real passing = 1.0f - fresnel_dielectric(cos_out, relative, unused);
        return passing * ggx.visible_density(out, half) * square(relative / sum_length) * -cos_in;
    }
};

}  // namespace opal
