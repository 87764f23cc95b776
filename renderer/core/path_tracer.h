// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/bsdf.h"
#include "renderer/core/camera_bodies.h"
#include "renderer/core/interior.h"
#include "renderer/core/scene_view.h"
#include "renderer/core/surface_probe.h"

/// The one path tracer. `Intersector` supplies bool closest(const Ray&, RayHit&, real max_mm), bool occluded(const Ray&, real
/// max_mm): Embree on the CPU.
namespace opal {

/// What one path found, per lane, before the division by the lane's wavelength density.
template <int N>
struct PathResult {
    Lanes<N> radiance;
    Lanes<N> truncated;  ///< throughput thrown away at the bounce limit: what unit radiance would have added
};

/// The illuminant at a path's wavelengths, looked up once.
template <int N>
struct LaneSpectra {
    real white[N];

    OPAL_HD LaneSpectra(const SpectrumTables& tables, const PathWavelengths<N>& wavelengths) {
        for (int i = 0; i < wavelengths.count; ++i) white[i] = table_at(tables.white, wavelengths.wavelength_nm[i]);
    }
};

template <int N, class Intersector>
class PathTracer {
  public:
    OPAL_HD PathTracer(const SceneView& scene, const Intersector& intersector, const PathWavelengths<N>& wavelengths,
                       PathRandom& random, PathCounters& counters)
        : scene_(scene),
          intersector_(intersector),
          wavelengths_(wavelengths),
          random_(random),
          counters_(counters),
          spectra_(scene.spectra, wavelengths) {
        weights_.count = wavelengths.count;
    }

    /// Traces one path from the camera. Where it first meets a body from the open it goes on both ways, each weighted by its
    /// Fresnel factor: reflections of the lights are far brighter than what is inside, and leaving them to chance is most of the
    /// noise.
    OPAL_HD PathResult<N> trace(const Ray& camera) {
        const NestedBodies start = bodies_at_start(scene_, intersector_, camera);
        bodies_ = start;
        follow(camera, 0);
        if (reflection_pending_) {
            weights_ = reflection_weights_;
            bodies_ = start;
            connected_ = false;
            follow(reflection_, 1);
        }
        return result_;
    }

  private:
    OPAL_HD_LARGE void follow(Ray ray, int bounce) {
        while (true) {
            SurfaceProbe<Intersector> ahead(intersector_, scene_.lights, ray, bounce == 0);
            const int body = bodies_.current();
            if (bounce >= scene_.max_bounces && (body >= 0 || (ahead.found() && !ahead.meets_light()))) {
                const Lanes<N> lost = weights_.contribution();
                for (int i = 0; i < weights_.count; ++i) result_.truncated.v[i] += lost.v[i];
                ++counters_.truncated_paths;
                return;
            }
            if (body >= 0) {
                load_body(body);
                const InteriorEvent event = cross_interior(scene_.bodies[body], wavelengths_, optics_, medium_, ray, ahead,
                                                           visit_, weights_, random_, counters_);
                if (event.kind != InteriorEventKind::surface) {
                    if (!(dot(event.direction, event.direction) > 0.5f)) {
                        ++counters_.not_a_number;
                        return;
                    }
                    ray = {event.position, event.direction};
                    connected_ = false;
                    // Going back and forth between two beams is one event, however many turns it takes.
                    if (!event.turned_back) ++bounce;
                    if (!survives_roulette(bounce)) return;
                    continue;
                }
                if (!ahead.found()) {
                    ++counters_.lost_paths;
                    return;
                }
            }
            if (!ahead.found()) {
                add_distant_lights(ray.direction, bounce == 0);
                return;
            }
            if (ahead.meets_light()) {
                if (ahead.light().shines) add_met_light(ray.direction, ahead.light().light);
                return;
            }
            const Surface surface = surface_at(scene_, ahead.hit());
            if (surface.body >= 0) {
                const bool entering = dot(ray.direction, surface.geometric_normal) < 0.0f;
                const NestedBodies beyond = entering ? bodies_.entered(surface.body) : bodies_.left(surface.body);
                if (object_of(beyond.current()) == object_of(body)) {
                    // The same object, of higher priority, is on both sides: there is no surface here.
                    bodies_ = beyond;
                    visit_.clear_mm = 0.0f;
                    ray = leaving(surface, ray.direction);
                    continue;
                }
                if (scene_.bodies[surface.body].roughness < min_roughness)
                    ray = meet_body(ray, surface, beyond, bounce);
                else if (!meet_rough_body(ray, surface, beyond))
                    return;
            } else if (!meet_opaque(ray, surface)) {
                return;
            }
            if (!survives_roulette(++bounce)) return;
        }
    }

    /// Makes the constants of a body at the path's wavelengths known.
    OPAL_HD void load_body(int body) {
        if (body == loaded_body_) return;
        medium_ = lane_medium(scene_.bodies[body].medium, wavelengths_);
        optics_ = lane_optics(scene_.bodies[body], wavelengths_);
        loaded_body_ = body;
    }

    /// -1 in the open.
    OPAL_HD int object_of(int body) const { return body < 0 ? -1 : scene_.bodies[body].object; }

    OPAL_HD void lane_indices(int body, real* index) {
        for (int i = 0; i < N; ++i)
            index[i] = body < 0 ? 1.0f : table_at(scene_.bodies[body].surface_index, wavelengths_.wavelength_nm[i]);
    }

    OPAL_HD bool disperses(int body) const { return body >= 0 && scene_.bodies[body].surface_disperses; }

    OPAL_HD Ray meet_body(const Ray& ray, const Surface& surface, NestedBodies beyond, int bounce) {
        real index_before[N], index_beyond[N];
        lane_indices(bodies_.current(), index_before);
        lane_indices(beyond.current(), index_beyond);
        const DielectricSplit<N> split = split_dielectric<N>(ray.direction, surface, index_before, index_beyond);
        if (bounce == 0 && bodies_.current() < 0) return keep_both(surface, split, beyond);
        const bool reflects = random_.next() < split.reflectance[0];
        for (int i = 1; i < weights_.count; ++i)
            weights_.ratio.v[i] *= reflects ? split.reflectance[i] / split.reflectance[0]
                                            : (1.0f - split.reflectance[i]) / (1.0f - split.reflectance[0]);
        if (reflects) {
            visit_.renew();
            connected_ = false;
            return leaving(surface, split.reflected);
        }
        return refracted(surface, split, beyond);
    }

    /// Keeps the reflected half for later and returns the refracted one.
    OPAL_HD Ray keep_both(const Surface& surface, const DielectricSplit<N>& split, NestedBodies beyond) {
        reflection_ = leaving(surface, split.reflected);
        reflection_weights_ = weights_;
        for (int i = 0; i < weights_.count; ++i) {
            reflection_weights_.throughput.v[i] *= split.reflectance[i];
            weights_.throughput.v[i] *= 1.0f - split.reflectance[i];
        }
        reflection_pending_ = true;
        return refracted(surface, split, beyond);
    }

    OPAL_HD Ray refracted(const Surface& surface, const DielectricSplit<N>& split, NestedBodies beyond) {
        // Each wavelength is refracted into a direction of its own: a companion would never have gone the hero's way.
        if (disperses(bodies_.current()) || disperses(beyond.current())) weights_.drop_companions();
        bodies_ = beyond;
        visit_.enter(0);
        connected_ = false;
        return leaving(surface, split.refracted);
    }

    OPAL_HD static Ray leaving(const Surface& surface, Vec3 direction) {
        return {offset_origin(surface.position, surface.geometric_normal, direction), direction};
    }

    /// Scatters the path at an opaque surface. Returns whether it goes on.
    OPAL_HD bool meet_opaque(Ray& ray, const Surface& surface) {
        const MaterialView& material = scene_.materials[surface.material];
        SurfaceInteraction<N> interaction;
        interaction.surface = surface;
        interaction.direction = ray.direction;
        lane_indices(bodies_.current(), interaction.index_before);
        // From inside a body the lights are behind its surface, where no straight line leads.
        const bool connects = bodies_.current() < 0 && connects_to_lights(material);
        if (connects) connect_lights(interaction, interaction.face_normal());
        visit_.renew();
        return go_on(sample_bsdf(material, scene_.spectra, wavelengths_, interaction, random_), connects, surface, ray);
    }

    /// The same at the rough surface of a body; lights are connected on the side that is in the open.
    OPAL_HD bool meet_rough_body(Ray& ray, const Surface& surface, NestedBodies beyond) {
        SurfaceInteraction<N> interaction;
        interaction.surface = surface;
        interaction.direction = ray.direction;
        lane_indices(bodies_.current(), interaction.index_before);
        lane_indices(beyond.current(), interaction.index_beyond);
        const bool open_before = bodies_.current() < 0, open_beyond = beyond.current() < 0;
        if (open_before) connect_lights(interaction, interaction.face_normal());
        if (open_beyond) connect_lights(interaction, -interaction.face_normal());
        const BsdfSample<N> sample =
            sample_interface(scene_.bodies[surface.body].roughness, wavelengths_, interaction, weights_, random_);
        if (sample.transmitted) {
            bodies_ = beyond;
            visit_.enter(0);
        } else {
            visit_.renew();
        }
        return go_on(sample, sample.transmitted ? open_beyond : open_before, surface, ray);
    }

    /// Follows a drawn direction; `connects`: lights were connected on its side.
    OPAL_HD bool go_on(const BsdfSample<N>& sample, bool connects, const Surface& surface, Ray& ray) {
        if (dot(sample.direction, sample.direction) == 0.0f) return false;
        for (int i = 0; i < weights_.count; ++i) {
            weights_.throughput.v[i] *= sample.weight.v[i];
            weights_.ratio.v[i] *= sample.ratio.v[i];
        }
        pdf_ = sample.pdf;
        connected_ = connects && pdf_ > 0.0f;
        drawn_from_ = surface.position;
        ray = leaving(surface, sample.direction);
        return true;
    }

    /// What the surface that the path has come to sends from there into a direction.
    OPAL_HD BsdfValue<N> evaluate(const SurfaceInteraction<N>& interaction, Vec3 direction) const {
        const Surface& surface = interaction.surface;
        if (surface.body >= 0)
            return evaluate_interface(scene_.bodies[surface.body].roughness, wavelengths_, interaction, weights_, direction);
        return evaluate_bsdf(scene_.materials[surface.material], scene_.spectra, wavelengths_, interaction, direction);
    }

    /// Weight of a direction drawn with density `pdf` that could have been drawn with `other_pdf` as well: the power heuristic
    /// (Veach 1997).
    OPAL_HD static real power_heuristic(real pdf, real other_pdf) {
        const real ratio = other_pdf / pdf;
        return 1.0f / (1.0f + ratio * ratio);
    }

    /// Light that a point receives from a drawn direction of one of the lights (next-event estimation), weighted against the
    /// directions that the path itself draws. `normal`: towards the side of the light.
    OPAL_HD void connect_lights(const SurfaceInteraction<N>& interaction, Vec3 normal) {
        if (scene_.light_sampling == LightSampling::scattering) return;
        const Vec3 position = interaction.surface.position;
        const real u = scene_.lights.count > 0 ? random_.next() : 0.0f;
        const real u1 = random_.next(), u2 = random_.next();
        const LightSample sample = sample_light(scene_.lights, scene_.environment, position, u, u1, u2);
        if (!(sample.pdf > 0.0f) || dot(sample.direction, normal) <= 0.0f) return;
        const Ray shadow{offset_origin(position, normal, sample.direction), sample.direction};
        const real reach_mm = sample.distance_mm * (1.0f - 1.0e-5f);
        if (lights_occlude(scene_.lights, shadow, reach_mm, sample.light) || intersector_.occluded(shadow, reach_mm)) return;
        const BsdfValue<N> value = evaluate(interaction, sample.direction);
        const real weight = scene_.light_sampling == LightSampling::both ? power_heuristic(sample.pdf, value.pdf) : 1.0f;
        Lanes<N> factor;
        for (int i = 0; i < weights_.count; ++i) factor.v[i] = weight * value.f_cosine.v[i] / sample.pdf;
        if (sample.light == environment_light)
            add_environment(sample.direction, factor);
        else
            add_light(sample.direction, sample.light, factor);
    }

    /// Weight of light that the path itself has met, against the connections from its last point.
    OPAL_HD Lanes<N> weight_of_met(Vec3 direction, int light) const {
        if (!connected_ || scene_.light_sampling == LightSampling::scattering) return Lanes<N>::all(1.0f);
        if (scene_.light_sampling == LightSampling::connections) return Lanes<N>::all(0.0f);
        return Lanes<N>::all(power_heuristic(pdf_, light_pdf(scene_.lights, scene_.environment, drawn_from_, direction, light)));
    }

    OPAL_HD void add_met_light(Vec3 direction, int light) { add_light(direction, light, weight_of_met(direction, light)); }

    /// The environment and the suns in front of it; `direct`: as the camera sees them.
    OPAL_HD void add_distant_lights(Vec3 direction, bool direct) {
        add_environment(direction, weight_of_met(direction, environment_light));
        for (int i = 0; i < scene_.lights.count; ++i) {
            if (direct && !scene_.lights.lights[i].visible) continue;
            const LightGeometry& geometry = scene_.lights.lights[i].geometry;
            if (geometry.shape == LightShape::sun && in_sun(geometry, direction)) add_met_light(direction, i);
        }
    }

    OPAL_HD void add_environment(Vec3 direction, const Lanes<N>& factor) {
        const Lanes<N> contribution = weights_.contribution();
        const EnvironmentFootprint footprint = environment_footprint(scene_.environment, direction);
        for (int i = 0; i < weights_.count; ++i)
            result_.radiance.v[i] += factor.v[i] * contribution.v[i] * spectra_.white[i] *
                                     environment_color(scene_.spectra, footprint, wavelengths_.wavelength_nm[i]);
    }

    OPAL_HD void add_light(Vec3 direction, int light, const Lanes<N>& factor) {
        const Lanes<N> contribution = weights_.contribution();
        for (int i = 0; i < weights_.count; ++i)
            result_.radiance.v[i] += factor.v[i] * contribution.v[i] *
                                     light_radiance(scene_.lights.lights[light], direction, wavelengths_.wavelength_nm[i]);
    }

    /// Russian roulette by the largest contribution of any lane: the same for every choice of the hero, so the lanes' ratios
    /// stay.
    OPAL_HD bool survives_roulette(int bounce) {
        if (bounce < 4 || !scene_.roulette) return true;
        const Lanes<N> contribution = weights_.contribution();
        real largest = 0.0f;
        for (int i = 0; i < weights_.count; ++i) largest = max_of(largest, contribution.v[i]);
        // A path that still carries more is worth its time: ending it brings more noise than it saves (opal-bench media-checks).
        constexpr real worth_following = 0.5f;
        if (!(largest < worth_following)) return true;
        const real kept = largest / worth_following;
        if (random_.next() >= kept) return false;
        for (int i = 0; i < weights_.count; ++i) weights_.throughput.v[i] /= kept;
        return true;
    }

    const SceneView& scene_;
    const Intersector& intersector_;
    const PathWavelengths<N>& wavelengths_;
    PathRandom& random_;
    PathCounters& counters_;
    LaneSpectra<N> spectra_;
    LaneMedium<N> medium_;
    LaneOptics<N> optics_;
    int loaded_body_ = -1;  ///< whose constants the two above are
    LaneWeights<N> weights_;
    GrainVisit<N> visit_;
    PathResult<N> result_;
    Ray reflection_;
    LaneWeights<N> reflection_weights_;
    bool reflection_pending_ = false;
    NestedBodies bodies_;     ///< where the path is
    bool connected_ = false;  ///< lights were sampled at the last point
    real pdf_ = 0.0f;         ///< with which the direction from there was drawn
    Vec3 drawn_from_;         ///< that point
};

/// The camera ray and the wavelengths of one sample, and its path: what a kernel does for one work index (pixel, sample).
template <int N, class Intersector>
OPAL_HD PathResult<N> trace_sample(const SceneView& scene, const Intersector& intersector, uint32_t pixel, uint32_t sample,
                                   PathWavelengths<N>& wavelengths, PathCounters& counters) {
    PathRandom random(scene.seed, pixel, sample, scene.sampler);
    const PixelNumbers numbers = random.pixel_numbers();
    const real x = 0.5f + sample_pixel_filter(scene.filter, numbers.x);
    const real y = 0.5f + sample_pixel_filter(scene.filter, numbers.y);
    wavelengths = sample_wavelengths<N>(scene.spectra, numbers.wavelength, scene.wavelengths);
    const bool lens = scene.camera.aperture_radius_mm > 0.0f;
    const real lens_u = lens ? random.next() : 0.0f, lens_v = lens ? random.next() : 0.0f;
    const Ray ray = camera_ray(scene.camera, (real(pixel % uint32_t(scene.width)) + x) / real(scene.width),
                               (real(pixel / uint32_t(scene.width)) + y) / real(scene.height), lens_u, lens_v);
    PathTracer<N, Intersector> tracer(scene, intersector, wavelengths, random, counters);
    PathResult<N> result = tracer.trace(ray);
    for (int i = 0; i < wavelengths.count; ++i)
        if (!(result.radiance.v[i] >= 0.0f && result.radiance.v[i] < 3.0e38f)) {
            ++counters.not_a_number;
            result.radiance = Lanes<N>{};
            break;
        }
    return result;
}

}  // namespace opal
