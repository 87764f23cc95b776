// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/host_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "formats/error.h"
#include "formats/units.h"
#include "renderer/host/enclosure.h"
#include "renderer/host/mesh_contact.h"
#include "renderer/host/mesh_file.h"
#include "renderer/host/mesh_topology.h"

namespace opal {
namespace {

Vec3 to_vec3(const std::array<double, 3>& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
}

SampledSpectrum illuminant_of(const EnvironmentDescription& environment) {
    return illuminant_spectrum(environment.illuminant, environment.temperature_k, environment.illuminant_file);
}

/// Places are floats, finest about their origin: that is to be where the camera looks, wherever in the scene. In steps, so that
/// scenes about their own origin stay as they are to the bit.
std::array<double, 3> origin_near(const std::array<double, 3>& target_mm) {
    constexpr double step_mm = 64.0;
    std::array<double, 3> origin_mm;
    for (std::size_t axis = 0; axis < 3; ++axis) origin_mm[axis] = step_mm * std::round(target_mm[axis] / step_mm);
    return origin_mm;
}

/// Everything moved so that `origin_mm` becomes the origin.
SceneDescription moved(SceneDescription scene, const std::array<double, 3>& origin_mm) {
    const auto move = [&](std::array<double, 3>& place_mm) {
        for (std::size_t axis = 0; axis < 3; ++axis) place_mm[axis] -= origin_mm[axis];
    };
    for (LightDescription& light : scene.lights) {
        move(light.position_mm);
        move(light.target_mm);
    }
    for (ObjectDescription& object : scene.objects) move(object.translate_mm);
    move(scene.camera.position_mm);
    move(scene.camera.target_mm);
    return scene;
}

/// Wavelengths are drawn for all the light there is where the camera looks.
SpectrumTablesData make_spectra(const SceneDescription& description, const EnvironmentMap& environment, const LightData& lights) {
    SpectrumTableOptions options;
    options.illuminant = illuminant_of(description.environment);
    options.upsampling = description.color.upsampling;
    options.alias = description.render.sampler == SamplerKind::independent;
    std::vector<double> light = lights.spectrum_at(to_vec3(description.camera.target_mm));
    const std::vector<double> white = colorimetric_table(options.illuminant);
    const double environment_share = double(environment_importance({nullptr, 0, environment.mean_luminance}));
    double total = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) total += light[i] += environment_share * white[i];
    if (total > 0.0) options.drawn_light = std::move(light);
    return make_spectrum_tables(options);
}

PathSampler path_sampler(SamplerKind kind) {
    switch (kind) {
        case SamplerKind::sobol:
            return PathSampler::sobol;
        case SamplerKind::stratified:
            return PathSampler::stratified;
        case SamplerKind::independent:
            break;
    }
    return PathSampler::independent;
}

LightSampling light_sampling(LightSamplingKind kind) {
    switch (kind) {
        case LightSamplingKind::connections:
            return LightSampling::connections;
        case LightSamplingKind::scattering:
            return LightSampling::scattering;
        case LightSamplingKind::both:
            break;
    }
    return LightSampling::both;
}

/// The four kinds stand in the same order.
PixelFilter pixel_filter(const RenderDescription& render) {
    return {static_cast<PixelFilterKind>(render.filter), float(render.filter_radius_px)};
}

}  // namespace

Camera make_camera(const CameraDescription& description, int width, int height) {
    Camera camera;
    camera.position = to_vec3(description.position_mm);
    const Vec3 view = to_vec3(description.target_mm) - camera.position;
    camera.forward = normalize(view);
    const Vec3 right = normalize(cross(camera.forward, to_vec3(description.up)));
    const Vec3 down = cross(camera.forward, right);
    camera.orthographic = description.kind == CameraKind::orthographic;
    const double picture_height = camera.orthographic ? description.view_height_mm
                                                      : 2.0 * std::tan(0.5 * units::rad_from_deg(description.vertical_fov_deg));
    camera.right = float(picture_height * width / height) * right;
    camera.down = float(picture_height) * down;
    camera.aperture_radius_mm = float(description.aperture_radius_mm);
    camera.focus_mm = description.focus_mm > 0.0 ? float(description.focus_mm) : length(view);
    return camera;
}

HostScene::HostScene(const SceneDescription& description, std::vector<std::string>& notices, OpalCache* opals)
    : HostScene(moved(description, origin_near(description.camera.target_mm)), origin_near(description.camera.target_mm), notices,
                opals) {}

HostScene::HostScene(const SceneDescription& description, const std::array<double, 3>& origin_mm,
                     std::vector<std::string>& notices, OpalCache* opals)
    : environment_(make_environment(description.environment, description.color.upsampling, &notices)),
      lights_(description.lights, description.color.upsampling, environment_.mean_luminance),
      spectra_(make_spectra(description, environment_, lights_)),
      guided_(description.render.guided) {
    tables_s_ = watch_.seconds();
    for (const MaterialDescription& material : description.materials)
        material_data_.emplace_back(material, spectra_.upsampling, description.opal.dispersion);
    OpalCache own;
    for (const ObjectDescription& object : description.objects) {
        if (object.kind == ObjectKind::opal)
            add_opal(object, (opals ? *opals : own).find(object, description.opal, notices));
        else
            add_mesh(object, description, notices);
    }
    const RenderDescription& render = description.render;
    view_.camera = make_camera(description.camera, render.width, render.height);
    order_bodies();
    place_camera(render);
    for (MaterialData& material : material_data_) {
        material.prepare_coat(bodies_);
        materials_.push_back(material.view());
    }
    for (const MeshData& mesh : meshes_) mesh_views_.push_back(mesh.view());
    view_.bodies = bodies_.data();
    view_.num_bodies = int(bodies_.size());
    view_.num_meshes = int(mesh_views_.size());
    view_.num_materials = int(materials_.size());
    view_.spectra = spectra_.view();
    view_.environment = environment_.view();
    view_.lights = lights_.view();
    require_lights_outside(description.lights, origin_mm);
    view_.meshes = mesh_views_.data();
    view_.materials = materials_.data();
    view_.width = render.width;
    view_.height = render.height;
    view_.max_bounces = render.max_bounces;
    view_.roulette = render.roulette;
    view_.wavelengths = 1 + description.opal.companions;
    view_.seed = render.seed;
    view_.sampler = path_sampler(render.sampler);
    view_.light_sampling = light_sampling(render.light_sampling);
    view_.filter = pixel_filter(render);
}

void HostScene::add_opal(const ObjectDescription& object, std::shared_ptr<const OpalBody> opal) {
    const RigidTransform transform = object_transform(object);
    opals_.push_back(std::move(opal));
    OpalView view = opals_.back()->placed(transform);
    view.object = int(opals_.size() + glasses_.size());
    for (MeshData& surface : opals_.back()->surfaces(transform)) {
        meshes_.push_back(std::move(surface));
        add_body(view, object.priority);
    }
}

/// The last mesh bounds it.
void HostScene::add_body(const OpalView& view, int priority) {
    if (bodies_.size() == std::size_t(max_bodies))
        throw InputError(fmt::format("the scene has more than {} transparent objects", max_bodies));
    meshes_.back().body = int(bodies_.size());
    bodies_.push_back(view);
    priorities_.push_back(priority);
}

/// Numbers the bodies by their priorities: of equal ones the later in the scene wins.
void HostScene::order_bodies() {
    std::vector<int> order(bodies_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return priorities_[a] < priorities_[b]; });
    std::vector<OpalView> ordered;
    std::vector<int> rank(bodies_.size());
    for (const int body : order) {
        rank[body] = int(ordered.size());
        ordered.push_back(bodies_[body]);
    }
    bodies_ = std::move(ordered);
    for (MeshData& mesh : meshes_)
        if (mesh.body >= 0) mesh.body = rank[mesh.body];
    for (const MeshData& mesh : meshes_) {
        if (mesh.body < 0) continue;
        // The level set tells how far its own surface is, nothing of others.
        OpalView& body = bodies_[mesh.body];
        for (const MeshData& other : meshes_)
            if (&other != &mesh && reaches_inside(other, body)) body.shape.grid = nullptr;
    }
}

/// Tells which bodies the camera's rays start in: alike for all of them where no surface cuts the places they start at.
void HostScene::place_camera(const RenderDescription& render) {
    const Camera& camera = view_.camera;
    const Vec3 x = normalize(camera.right), y = normalize(camera.down);
    const float outside_px = float(std::max(0.5, render.filter_radius_px));  // a filter draws rays beyond the picture's edge
    float half_x = camera.aperture_radius_mm, half_y = camera.aperture_radius_mm;
    if (camera.orthographic) {
        half_x += (0.5f + outside_px / float(render.width)) * length(camera.right);
        half_y += (0.5f + outside_px / float(render.height)) * length(camera.down);
    }
    for (const MeshData& mesh : meshes_) {
        if (mesh.body < 0) continue;
        // Where the lens is a point, none of its rays differ.
        if (half_x > 0.0f && touches_rectangle(mesh, camera.position, half_x * x, half_y * y, mesh.deviation_mm))
            view_.cut_bodies = view_.cut_bodies.entered(mesh.body);
        else if (encloses(mesh, camera.position))
            view_.camera_bodies = view_.camera_bodies.entered(mesh.body);
    }
}

void HostScene::require_lights_outside(const std::vector<LightDescription>& lights,
                                       const std::array<double, 3>& origin_mm) const {
    for (std::size_t i = 0; i < lights.size(); ++i)
        for (const MeshData& mesh : meshes_) {
            if (lights[i].kind == LightKind::sun || mesh.body < 0) continue;
            const LightGeometry& geometry = view_.lights.lights[i].geometry;
            const bool touches = touches_light(mesh, geometry);
            if (touches || encloses(mesh, geometry.position))
                throw InputError(
                    fmt::format("light.{}: {} [{:.9g}, {:.9g}, {:.9g}] {} a transparent object; lights must be outside, with all "
                                "of their size",
                                i, touches ? "the light at" : "stands at", lights[i].position_mm[0] + origin_mm[0],
                                lights[i].position_mm[1] + origin_mm[1], lights[i].position_mm[2] + origin_mm[2],
                                touches ? "reaches into" : "inside"));
        }
}

const std::string& HostScene::recipe_toml() const {
    static const std::string none;
    return opals_.empty() ? none : opals_.front()->recipe_toml();
}

std::size_t HostScene::num_grains() const {
    std::size_t sum = 0;
    for (const auto& opal : opals_) sum += opal->num_grains();
    return sum;
}

int HostScene::reciprocal_points() const {
    int most = 0;
    for (const auto& opal : opals_) most = std::max(most, opal->reciprocal_points());
    return most;
}

void HostScene::add_mesh(const ObjectDescription& object, const SceneDescription& scene, std::vector<std::string>& notices) {
    MeshData mesh;
    switch (object.kind) {
        case ObjectKind::plane:
            mesh = make_plane(object.size_mm);
            break;
        case ObjectKind::sphere:
            mesh = make_sphere(object.radius_mm);
            break;
        case ObjectKind::cylinder:
            mesh = make_cylinder(object.radius_mm, object.height_mm, object.bevel_mm);
            break;
        default:
            mesh = load_mesh(object.file, object.smooth_normals_deg, notices);
            break;
    }
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const MaterialDescription& material) { return material.name == object.material; });
    if (found->kind == MaterialKind::dielectric) return add_glass(object, *found, scene.opal, std::move(mesh));
    transform_mesh(mesh, object_transform(object));
    mesh.material = static_cast<int>(found - scene.materials.begin());
    meshes_.push_back(std::move(mesh));
}

void HostScene::add_glass(const ObjectDescription& object, const MaterialDescription& material, const OpalDescription& settings,
                          MeshData mesh) {
    if (const std::size_t open = count_open_edges(mesh); open > 0)
        throw InputError(fmt::format("{}: the surface has {} open edges; a dielectric ('{}') needs a closed one",
                                     object.file.string(), open, material.name));
    if (signed_volume6(mesh) < 0.0) turn_inside_out(mesh);
    openvdb::BBoxd bounds_mm;
    for (const Vec3& p : mesh.positions) bounds_mm.expand(openvdb::Vec3d(double(p.x), double(p.y), double(p.z)));
    glasses_.push_back(std::make_unique<GlassBody>(object, material, settings, bounds_mm));
    transform_mesh(mesh, object_transform(object));
    meshes_.push_back(std::move(mesh));
    OpalView view = glasses_.back()->view();
    view.object = int(opals_.size() + glasses_.size());
    add_body(view, object.priority);
}

}  // namespace opal
