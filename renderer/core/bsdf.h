// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/lane_weights.h"
#include "renderer/core/material.h"
#include "renderer/core/path_random.h"
#include "renderer/core/surface_scattering.h"

/// How surfaces scatter light: drawn directions with what the lanes' weights become, and the same for given directions, so that
/// lights can be connected.
namespace opal {

/// A path that has come to a surface.
template <int N>
struct SurfaceInteraction {
    Surface surface;
    Vec3 direction;  ///< unit, travelling towards the surface
    float index_before[N];
    float index_beyond[N];  ///< bodies only

    /// Unit normal on the side that the path comes from.
    OPAL_HD Vec3 face_normal() const {
        return dot(direction, surface.geometric_normal) < 0.0f ? surface.geometric_normal : -surface.geometric_normal;
    }
    OPAL_HD Vec3 facing_shading_normal() const {
        return dot(direction, surface.geometric_normal) < 0.0f ? surface.shading_normal : -surface.shading_normal;
    }
};

/// A drawn direction.
template <int N>
struct BsdfSample {
    Vec3 direction;    ///< unit; zero: the path ends here
    Lanes<N> weight;   ///< f |cos| over the lane's own density
    Lanes<N> ratio;    ///< the lane's own density over the hero's
    float pdf = 0.0f;  ///< hero's density, 1/sr; 0: one of finitely many directions
    bool transmitted = false;
};

/// What the surface sends from the path's side into a given direction.
template <int N>
struct BsdfValue {
    Lanes<N> f_cosine;  ///< f |cos|, 1/sr
    float pdf = 0.0f;   ///< density with which sample_bsdf draws it for the hero, 1/sr
};

/// Whether a light can be connected to a point of the material.
OPAL_HD inline bool connects_to_lights(const MaterialView& material) {
    return material.model == MaterialModel::diffuse;
}

template <int N>
OPAL_HD inline BsdfValue<N> evaluate_bsdf(const MaterialView& material, const SpectrumTables& tables,
                                          const PathWavelengths<N>& wavelengths, const SurfaceInteraction<N>& interaction,
                                          Vec3 direction_out) {
    BsdfValue<N> value;
    value.pdf = max_of(0.0f, dot(direction_out, interaction.face_normal())) / pi_f;
    for (int i = 0; i < wavelengths.count; ++i)
        value.f_cosine.v[i] = value.pdf * upsampled(tables, material.albedo, wavelengths.wavelength_nm[i]);
    return value;
}

template <int N>
OPAL_HD inline BsdfSample<N> sample_bsdf(const MaterialView& material, const SpectrumTables& tables,
                                         const PathWavelengths<N>& wavelengths, const SurfaceInteraction<N>& interaction,
                                         PathRandom& random) {
    BsdfSample<N> sample;
    const Vec3 normal = interaction.face_normal();
    const float u1 = random.next(), u2 = random.next();
    sample.direction = sample_cosine(normal, u1, u2);
    sample.pdf = max_of(0.0f, dot(sample.direction, normal)) / pi_f;
    sample.ratio = Lanes<N>::all(1.0f);
    for (int i = 0; i < wavelengths.count; ++i)
        sample.weight.v[i] = upsampled(tables, material.albedo, wavelengths.wavelength_nm[i]);
    return sample;
}

}  // namespace opal
