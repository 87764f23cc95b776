// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/interior.h"
#include "renderer/core/surface_probe.h"
#include "renderer/core/surface_scattering.h"

/// Light followed from the lights into a body, to learn where it comes from there.
namespace opal {

/// A ball around a body.
struct BodyBounds {
    Vec3 center_mm;
    real radius_mm = 0.0f;
};

/// Flights that a photon is followed for: later ones say little that earlier ones have not said.
inline constexpr int photon_flights = 24;

/// A ray of light on its way to a body, and what it carries: spectral radiance times response over the densities it was drawn
/// with.
struct EmittedPhoton {
    Ray ray;
    real power = 0.0f;  ///< 0: nothing comes this way
};

template <class Intersector>
OPAL_HD inline EmittedPhoton emit_photon(const SceneView& scene, const Intersector& intersector, const BodyBounds& bounds,
                                         const PathWavelengths<1>& wavelengths, PathRandom& random) {
    EmittedPhoton photon;
    const real u = random.next(), u1 = random.next(), u2 = random.next(), u3 = random.next(), u4 = random.next();
    const LightSample sample = sample_light(scene.lights, scene.environment, bounds.center_mm, u, u1, u2);
    if (!(sample.pdf > 0.0f)) return photon;
    const real wavelength_nm = wavelengths.wavelength_nm[0];
    const real radius_mm = bounds.radius_mm * sqrt(u3), angle_rad = 2.0f * pi_f * u4;
    const Vec3 across = Frame(sample.direction).world_from_local({radius_mm * cos(angle_rad), radius_mm * sin(angle_rad), 0.0f});
    const Vec3 place = bounds.center_mm + across;
    real radiance;
    if (sample.distance_mm < 1.0e30f) {
        const Vec3 source = bounds.center_mm + sample.distance_mm * sample.direction;
        photon.ray = {source, normalize(place - source)};
        photon.ray.origin = source + (1.0e-4f * sample.distance_mm) * photon.ray.direction;
        radiance = light_radiance(scene.lights.lights[sample.light], -photon.ray.direction, wavelength_nm);
    } else {
        const Vec3 start = place + (2.0f * bounds.radius_mm) * sample.direction;
        if (intersector.occluded({start, sample.direction}, 3.0e38f)) return photon;
        photon.ray = {start, -sample.direction};
        radiance =
            sample.light == environment_light
                ? table_at(scene.spectra.white, wavelength_nm) *
                      environment_color(scene.spectra, environment_footprint(scene.environment, sample.direction), wavelength_nm)
                : light_radiance(scene.lights.lights[sample.light], -sample.direction, wavelength_nm);
    }
    const Vec3 observer = table_at(scene.spectra.observer, wavelength_nm);
    photon.power = radiance * (observer.x + observer.y + observer.z) / (wavelengths.pdf_per_nm[0] * sample.pdf);
    return photon;
}

/// Follows photon number `index` into the body and calls deposit(from, direction, length_mm, power) for each straight flight
/// inside it. What leaves the body, and what meets others, is given up: a guide may be incomplete.
template <class Intersector, class Deposit>
OPAL_HD inline void trace_photon(const SceneView& scene, const Intersector& intersector, int body, const BodyBounds& bounds,
                                 uint32_t index, const Deposit& deposit) {
    // No picture has so many pixels: these numbers are no path's.
    PathRandom random(scene.seed, 0xFFFFFFFFu - uint32_t(body), index);
    const PathWavelengths<1> wavelengths = sample_wavelengths<1>(scene.spectra, random.next(), 1);
    const EmittedPhoton photon = emit_photon(scene, intersector, bounds, wavelengths, random);
    if (!(photon.power > 0.0f)) return;
    const OpalView& opal = scene.bodies[body];
    const LaneMedium<1> medium = lane_medium(opal.medium, wavelengths);
    const LaneOptics<1> optics = lane_optics(opal, wavelengths);
    const real outside_index = 1.0f;
    LaneWeights<1> weights;
    GrainVisit<1> visit;
    PathCounters counters;
    Ray ray = photon.ray;
    bool inside = false;
    for (int flight = 0; flight < photon_flights; ++flight) {
        SurfaceProbe<Intersector> ahead(intersector, scene.lights, ray, false);
        if (inside) {
            const InteriorEvent event =
                cross_interior(opal, wavelengths, optics, medium, ray, ahead, visit, weights, random, counters);
            deposit(ray.origin, ray.direction, length(event.position - ray.origin), photon.power * weights.throughput.v[0]);
            if (event.kind != InteriorEventKind::surface) {
                if (!(dot(event.direction, event.direction) > 0.5f)) return;
                ray = {event.position, event.direction};
                continue;
            }
        }
        if (!ahead.found() || ahead.meets_light()) return;
        const Surface surface = surface_at(scene, ahead.hit());
        if (surface.body != body) return;
        const DielectricSplit<1> split = inside
                                             ? split_dielectric<1>(ray.direction, surface, optics.surface_index, &outside_index)
                                             : split_dielectric<1>(ray.direction, surface, &outside_index, optics.surface_index);
        const bool reflects = random.next() < split.reflectance[0];
        if (reflects != inside) return;
        const Vec3 direction = reflects ? split.reflected : split.refracted;
        if (reflects)
            visit.renew();
        else
            visit.enter(0);
        inside = true;
        ray = {offset_origin(surface.position, surface.geometric_normal, direction), direction};
    }
}

}  // namespace opal
