// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/aovs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "formats/colorimetry.h"
#include "renderer/core/conductor.h"
#include "renderer/core/fresnel.h"
#include "renderer/core/strongest_family.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

/// What the AOVs of one picture share.
struct AovScene {
    const SceneView& view;
    const EmbreeScene& intersector;
    std::vector<Rgb> albedos;  ///< of the materials
};

/// What a ray through the picture meets first.
struct FirstHit {
    Ray ray;
    bool found = false;
    RayHit hit;
    Surface surface;
};

FirstHit first_hit(const AovScene& scene, float x, float y) {
    FirstHit first;
    first.ray = camera_ray(scene.view.camera, x / float(scene.view.width), y / float(scene.view.height), 0.0f, 0.0f);
    first.found = scene.intersector.closest(first.ray, first.hit);
    if (first.found) first.surface = surface_at(scene.view, first.hit);
    return first;
}

/// The opal behind what was met; null for opaque things and for glass.
const OpalView* opal_behind(const AovScene& scene, const FirstHit& first) {
    if (!first.found || first.surface.body < 0) return nullptr;
    const OpalView& body = scene.view.bodies[first.surface.body];
    return body.orientations ? &body : nullptr;
}

/// What a material reflects: metals at normal incidence, plastic by its base.
float reflectance_of(const SpectrumTables& tables, const MaterialView& material, float wavelength_nm) {
    if (material.model == MaterialModel::conductor)
        return fresnel_conductor(1.0f, table_at(material.index, wavelength_nm), table_at(material.extinction, wavelength_nm));
    return upsampled(tables, material.albedo, wavelength_nm);
}

/// Linear sRGB of what a material reflects of the scene's illuminant, which counts as white.
Rgb albedo_of(const SpectrumTables& tables, const MaterialView& material) {
    Xyz lit = {0.0, 0.0, 0.0}, white = {0.0, 0.0, 0.0};
    for (int i = 0; i < spectrum_samples; ++i) {
        const double light = double(tables.white[i]);
        const double reflected = light * double(reflectance_of(tables, material, spectrum_min_nm + float(i)));
        const Vec3 observer = tables.observer[i];
        lit = {lit.x + reflected * double(observer.x), lit.y + reflected * double(observer.y),
               lit.z + reflected * double(observer.z)};
        white = {white.x + light * double(observer.x), white.y + light * double(observer.y),
                 white.z + light * double(observer.z)};
    }
    const Xyz unit_white = {white.x / white.y, 1.0, white.z / white.y};
    const Rgb3d rgb = linear_srgb_from_xyz(bradford_adaptation(unit_white, srgb_white) *
                                           Xyz{lit.x / white.y, lit.y / white.y, lit.z / white.y});
    return {float(rgb.r), float(rgb.g), float(rgb.b)};
}

using AovWriter = void (*)(const AovScene&, const FirstHit&, int x, int y, float* target);

void write_object_id(const AovScene&, const FirstHit& first, int, int, float* target) {
    *target = first.found ? float(first.hit.mesh) : -1.0f;
}

void write_depth(const AovScene&, const FirstHit& first, int, int, float* target) {
    *target = first.found ? first.hit.distance_mm : 0.0f;
}

void write_normal(const AovScene&, const FirstHit& first, int, int, float* target) {
    if (!first.found) return;
    target[0] = first.surface.shading_normal.x;
    target[1] = first.surface.shading_normal.y;
    target[2] = first.surface.shading_normal.z;
}

void write_grain_id(const AovScene& scene, const FirstHit& first, int, int, float* target) {
    const OpalView* opal = opal_behind(scene, first);
    if (!opal) return;
    const RigidTransform& transform = opal->world_from_object;
    GrainPath walk(opal->grains, transform.local_from_world_point(first.surface.position),
                   transform.local_from_world_direction(-first.surface.geometric_normal));
    real distance = 0.0f;
    *target = float(walk.next_grain(0, distance, 3.0f / opal->grains.voxels.voxels_per_mm));
}

void write_albedo(const AovScene& scene, const FirstHit&, int x, int y, float* target) {
    constexpr int across = 4;
    for (int sample = 0; sample < across * across; ++sample) {
        const FirstHit first = first_hit(scene, float(x) + (float(sample % across) + 0.5f) / across,
                                         float(y) + (float(sample / across) + 0.5f) / across);
        if (!first.found) continue;
        const Rgb albedo = first.surface.body >= 0 ? Rgb{1.0f, 1.0f, 1.0f} : scene.albedos[std::size_t(first.surface.material)];
        target[0] += albedo.r / float(across * across);
        target[1] += albedo.g / float(across * across);
        target[2] += albedo.b / float(across * across);
    }
}

/// Of white light (X + Y + Z near 3), what must be turned to count as a diffraction.
constexpr float visible_turn = 3.0e-3f;

/// The first turn of a ray that goes straight through an opal's grains.
FamilyTurn first_turn(const AovScene& scene, const OpalView& opal, const Ray& inside) {
    RayHit exit;
    if (!scene.intersector.closest(inside, exit)) return {};
    const RigidTransform& transform = opal.world_from_object;
    GrainPath walk(opal.grains, transform.local_from_world_point(inside.origin),
                   transform.local_from_world_direction(inside.direction));
    const real end = exit.distance_mm / transform.scale;
    real distance = 0.0f;
    for (int grain = walk.next_grain(0, distance, end); grain != 0;) {
        const real entered = distance;
        const int next = walk.next_grain(grain, distance, end);
        const FamilyTurn turn =
            strongest_family(opal, scene.view.spectra, grain, inside.direction, (distance - entered) * transform.scale);
        if (turn.turned >= visible_turn) return turn;
        grain = next;
    }
    return {};
}

void write_hkl(const AovScene& scene, const FirstHit& first, int, int, float* target) {
    const OpalView* opal = opal_behind(scene, first);
    if (!opal || opal->diffraction == Diffraction::none) return;
    const Vec3 direction = first.ray.direction;
    Vec3 normal = first.surface.shading_normal;
    if (dot(direction, normal) >= 0.0f) return;
    const real index = table_at(opal->surface_index, 550.0f), cos_incident = -dot(direction, normal);
    real cos_transmitted = 0.0f;
    fresnel_dielectric(cos_incident, index, cos_transmitted);
    const Vec3 refracted = refract(direction, normal, index, cos_incident, cos_transmitted);
    const FamilyTurn turn =
        first_turn(scene, *opal, {offset_origin(first.surface.position, first.surface.geometric_normal, refracted), refracted});
    if (turn.pair < 0) return;
    const PlanePair& pair = opal->pairs[turn.pair];
    const float sign = turn.towards_g ? 1.0f : -1.0f;
    target[0] = sign * float(pair.h);
    target[1] = sign * float(pair.k);
    target[2] = sign * float(pair.l);
    target[3] = turn.wavelength_nm;
}

struct Aov {
    const char* name;
    std::vector<const char*> channels;
    AovWriter write;
};

const Aov* find_aov(const std::string& name) {
    static const Aov all[] = {{"object_id", {"object_id"}, write_object_id},
                              {"grain_id", {"grain_id"}, write_grain_id},
                              {"depth", {"depth"}, write_depth},
                              {"normal", {"normal.X", "normal.Y", "normal.Z"}, write_normal},
                              {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, write_albedo},
                              {"hkl", {"hkl.h", "hkl.k", "hkl.l", "hkl.wavelength_nm"}, write_hkl}};
    const Aov* found = std::find_if(std::begin(all), std::end(all), [&](const Aov& aov) { return name == aov.name; });
    return found == std::end(all) ? nullptr : found;
}

std::vector<Rgb> material_albedos(const HostScene& scene) {
    std::vector<Rgb> albedos;
    for (const MeshData& mesh : scene.meshes()) {
        if (mesh.material < 0) continue;
        albedos.resize(std::max(albedos.size(), std::size_t(mesh.material) + 1));
        albedos[std::size_t(mesh.material)] = albedo_of(scene.view().spectra, scene.view().materials[mesh.material]);
    }
    return albedos;
}

}  // namespace

void add_aovs(const HostScene& scene, const EmbreeScene& intersector, const std::vector<std::string>& aovs, Image& image) {
    std::vector<const Aov*> wanted;
    const std::size_t old_channels = image.channel_names.size();
    for (const std::string& name : aovs) {
        const Aov* aov = find_aov(name);
        if (!aov || std::find(wanted.begin(), wanted.end(), aov) != wanted.end()) continue;
        wanted.push_back(aov);
        image.channel_names.insert(image.channel_names.end(), aov->channels.begin(), aov->channels.end());
    }
    if (wanted.empty()) return;
    const AovScene aov_scene{scene.view(), intersector, material_albedos(scene)};
    const std::size_t channels = image.channel_names.size();
    std::vector<float> pixels(std::size_t(image.width) * image.height * channels, 0.0f);
    tbb::parallel_for(0, image.height, [&](int row) {
        for (int column = 0; column < image.width; ++column) {
            const std::size_t pixel = std::size_t(row) * image.width + column;
            float* target = pixels.data() + pixel * channels;
            std::copy_n(image.pixels.data() + pixel * old_channels, old_channels, target);
            target += old_channels;
            const int x = image.x0 + column, y = image.y0 + row;
            const FirstHit first = first_hit(aov_scene, float(x) + 0.5f, float(y) + 0.5f);
            for (const Aov* aov : wanted) {
                aov->write(aov_scene, first, x, y, target);
                target += aov->channels.size();
            }
        }
    });
    image.pixels = std::move(pixels);
}

}  // namespace opal
