// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bsdf_sample.h"
#include "renderer/core/conductor.h"
#include "renderer/core/lane_weights.h"
#include "renderer/core/material.h"
#include "renderer/core/path_random.h"
#include "renderer/core/plastic.h"
#include "renderer/core/rough_interface.h"
#include "renderer/core/surface_scattering.h"

/// How surfaces scatter light: drawn directions with what the lanes' weights become, and the same for given directions, so that
/// lights can be connected.
namespace opal {

/// A path that has come to a surface.
template <int N>
struct SurfaceInteraction {
    Surface surface;
    Vec3 direction;  ///< unit, travelling towards the surface
    real index_before[N];
    real index_beyond[N];  ///< bodies only

    /// Unit normal on the side that the path comes from.
    OPAL_HD Vec3 face_normal() const {
        return dot(direction, surface.geometric_normal) < 0.0f ? surface.geometric_normal : -surface.geometric_normal;
    }
    OPAL_HD Vec3 facing_shading_normal() const {
        return dot(direction, surface.geometric_normal) < 0.0f ? surface.shading_normal : -surface.shading_normal;
    }
    /// About the interpolated normal, or the face's own where that one looks away from the path.
    OPAL_HD Frame frame() const {
        const Vec3 shading = facing_shading_normal();
        return Frame(dot(direction, shading) < 0.0f ? shading : face_normal());
    }
};

namespace bsdf_detail {

template <int N>
OPAL_HD inline Conductor<N> conductor_at(const MaterialView& material, const PathWavelengths<N>& wavelengths,
                                         const SurfaceInteraction<N>& interaction) {
    Conductor<N> conductor;
    conductor.roughness = material.roughness;
    conductor.count = wavelengths.count;
    for (int i = 0; i < wavelengths.count; ++i) {
        conductor.n[i] = table_at(material.index, wavelengths.wavelength_nm[i]) / interaction.index_before[i];
        conductor.k[i] = table_at(material.extinction, wavelengths.wavelength_nm[i]) / interaction.index_before[i];
    }
    return conductor;
}

template <int N>
OPAL_HD inline Plastic<N> plastic_at(const MaterialView& material, const SpectrumTables& tables,
                                     const PathWavelengths<N>& wavelengths, const SurfaceInteraction<N>& interaction) {
    Plastic<N> plastic;
    plastic.roughness = material.roughness;
    plastic.coat_albedo = material.coat_albedo;
    plastic.count = wavelengths.count;
    for (int i = 0; i < wavelengths.count; ++i) {
        plastic.eta[i] = table_at(material.index, wavelengths.wavelength_nm[i]) / interaction.index_before[i];
        plastic.albedo[i] = upsampled(tables, material.albedo, wavelengths.wavelength_nm[i]);
    }
    return plastic;
}

template <int N>
OPAL_HD inline RoughInterface<N> interface_at(real roughness, const PathWavelengths<N>& wavelengths,
                                              const SurfaceInteraction<N>& interaction) {
    RoughInterface<N> rough;
    rough.roughness = roughness;
    rough.count = wavelengths.count;
    for (int i = 0; i < wavelengths.count; ++i) rough.eta[i] = interaction.index_beyond[i] / interaction.index_before[i];
    return rough;
}

/// A direction drawn in `frame` as one of the world; none where the triangle itself is on its other side.
template <int N>
OPAL_HD inline BsdfSample<N> in_world(BsdfSample<N> sample, const Frame& frame, Vec3 face) {
    if (dot(sample.direction, sample.direction) == 0.0f) return sample;
    sample.direction = normalize(frame.world_from_local(sample.direction));
    const real height = dot(sample.direction, face);
    if (sample.transmitted ? !(height < 0.0f) : !(height > 0.0f)) sample.direction = {};
    return sample;
}

template <int N>
OPAL_HD inline BsdfSample<N> sample_diffuse(const MaterialView& material, const SpectrumTables& tables,
                                            const PathWavelengths<N>& wavelengths, const Frame& frame, PathRandom& random) {
    BsdfSample<N> sample;
    const real u1 = random.next(), u2 = random.next();
    const Vec3 direction = sample_cosine(frame.normal, u1, u2);
    sample.direction = frame.local_from_world(direction);
    sample.pdf = max_of(0.0f, sample.direction.z) / pi_f;
    sample.ratio = Lanes<N>::all(1.0f);
    for (int i = 0; i < wavelengths.count; ++i)
        sample.weight.v[i] = upsampled(tables, material.albedo, wavelengths.wavelength_nm[i]);
    return sample;
}

}  // namespace bsdf_detail

/// Whether a light can be connected to a point of the material.
OPAL_HD inline bool connects_to_lights(const MaterialView& material) {
    return material.model != MaterialModel::conductor || material.roughness >= min_roughness;
}

/// What an opaque surface sends back: nothing into its other side.
template <int N>
OPAL_HD inline BsdfValue<N> evaluate_bsdf(const MaterialView& material, const SpectrumTables& tables,
                                          const PathWavelengths<N>& wavelengths, const SurfaceInteraction<N>& interaction,
                                          Vec3 direction_out) {
    BsdfValue<N> value;
    if (!(dot(direction_out, interaction.face_normal()) > 0.0f)) return value;
    const Frame frame = interaction.frame();
    const Vec3 out = frame.local_from_world(-interaction.direction), in = frame.local_from_world(direction_out);
    switch (material.model) {
        case MaterialModel::conductor:
            return bsdf_detail::conductor_at(material, wavelengths, interaction).evaluate(out, in);
        case MaterialModel::plastic:
            return bsdf_detail::plastic_at(material, tables, wavelengths, interaction).evaluate(out, in);
        case MaterialModel::diffuse:
            break;
    }
    value.pdf = max_of(0.0f, in.z) / pi_f;
    for (int i = 0; i < wavelengths.count; ++i)
        value.f_cosine.v[i] = value.pdf * upsampled(tables, material.albedo, wavelengths.wavelength_nm[i]);
    return value;
}

template <int N>
OPAL_HD inline BsdfSample<N> sample_bsdf(const MaterialView& material, const SpectrumTables& tables,
                                         const PathWavelengths<N>& wavelengths, const SurfaceInteraction<N>& interaction,
                                         PathRandom& random) {
    const Frame frame = interaction.frame();
    const Vec3 out = frame.local_from_world(-interaction.direction);
    BsdfSample<N> sample;
    switch (material.model) {
        case MaterialModel::conductor:
            sample = bsdf_detail::conductor_at(material, wavelengths, interaction).sample(out, random);
            break;
        case MaterialModel::plastic:
            sample = bsdf_detail::plastic_at(material, tables, wavelengths, interaction).sample(out, random);
            break;
        case MaterialModel::diffuse:
            sample = bsdf_detail::sample_diffuse(material, tables, wavelengths, frame, random);
            break;
    }
    return bsdf_detail::in_world(sample, frame, interaction.face_normal());
}

/// What a rough surface (roughness from min_roughness) between two bodies sends into a direction on either side. As lanes of
/// other indices draw directions with other densities, pdf is their mean, each lane counting by its ratio: the same whichever
/// lane leads, as the weights of connected lights must be.
template <int N>
OPAL_HD inline BsdfValue<N> evaluate_interface(real roughness, const PathWavelengths<N>& wavelengths,
                                               const SurfaceInteraction<N>& interaction, const LaneWeights<N>& weights,
                                               Vec3 direction_out) {
    const Frame frame = interaction.frame();
    const Vec3 out = frame.local_from_world(-interaction.direction), in = frame.local_from_world(direction_out);
    if ((in.z > 0.0f) != (dot(direction_out, interaction.face_normal()) > 0.0f)) return {};
    BsdfValue<N> value = bsdf_detail::interface_at(roughness, wavelengths, interaction).evaluate(out, in);
    real density = 0.0f, sum = 0.0f;
    for (int i = 0; i < weights.count; ++i) {
        density += weights.ratio.v[i] * value.f_cosine.v[i];  // a lane's density, as its weight is 1
        sum += weights.ratio.v[i];
    }
    value.pdf = density / sum;
    return value;
}

template <int N>
OPAL_HD inline BsdfSample<N> sample_interface(real roughness, const PathWavelengths<N>& wavelengths,
                                              const SurfaceInteraction<N>& interaction, const LaneWeights<N>& weights,
                                              PathRandom& random) {
    const Frame frame = interaction.frame();
    const Vec3 out = frame.local_from_world(-interaction.direction);
    BsdfSample<N> sample = bsdf_detail::interface_at(roughness, wavelengths, interaction).sample(out, random);
    real ratio = 0.0f, sum = 0.0f;
    for (int i = 0; i < weights.count; ++i) {
        ratio += weights.ratio.v[i] * sample.ratio.v[i];
        sum += weights.ratio.v[i];
    }
    sample.pdf *= ratio / sum;
    return bsdf_detail::in_world(sample, frame, interaction.face_normal());
}

}  // namespace opal
