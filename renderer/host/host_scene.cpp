// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/host_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "formats/error.h"
#include "formats/units.h"
#include "renderer/host/enclosure.h"
#include "renderer/host/upsampler.h"

namespace opal {
namespace {

Vec3 to_vec3(const std::array<double, 3>& v) {
    return {float(v[0]), float(v[1]), float(v[2])};
}

SampledSpectrum illuminant_of(const EnvironmentDescription& environment) {
    return illuminant_spectrum(environment.illuminant, environment.temperature_k, environment.illuminant_file);
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
    : spectra_(make_spectrum_tables({illuminant_of(description.environment), description.color.upsampling,
                                     description.render.sampler == SamplerKind::independent})),
      environment_(make_environment(description.environment, description.color.upsampling)) {
    tables_s_ = watch_.seconds();
    for (const MaterialDescription& material : description.materials)
        materials_.push_back({MaterialModel::diffuse,
                              upsample_reflectance(spectra_.upsampling, {float(material.albedo[0]), float(material.albedo[1]),
                                                                         float(material.albedo[2])})});
    OpalCache own;
    for (const ObjectDescription& object : description.objects) {
        if (object.kind == ObjectKind::opal)
            add_opal(object, (opals ? *opals : own).find(object, description.opal, notices));
        else
            add_mesh(object, description.materials);
    }
    const RenderDescription& render = description.render;
    view_.camera = make_camera(description.camera, render.width, render.height);
    order_bodies();
    for (const MeshData& mesh : meshes_) mesh_views_.push_back(mesh.view());
    view_.bodies = bodies_.data();
    view_.spectra = spectra_.view();
    view_.environment = environment_.view();
    view_.meshes = mesh_views_.data();
    view_.materials = materials_.data();
    view_.width = render.width;
    view_.height = render.height;
    view_.max_bounces = render.max_bounces;
    view_.wavelengths = 1 + description.opal.companions;
    view_.seed = render.seed;
    view_.stratified = render.sampler == SamplerKind::stratified;
    view_.filter = pixel_filter(render);
}

void HostScene::add_opal(const ObjectDescription& object, std::shared_ptr<const OpalBody> opal) {
    const RigidTransform transform = object_transform(object);
    meshes_.push_back(opal->surface());
    transform_mesh(meshes_.back(), transform);
    add_body(opal->placed(transform), object.priority);
    opals_.push_back(std::move(opal));
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
        if (encloses(mesh, view_.camera.position)) view_.camera_bodies = view_.camera_bodies.entered(mesh.body);
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

void HostScene::add_mesh(const ObjectDescription& object, const std::vector<MaterialDescription>& materials) {
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
            mesh = load_mesh(object.file);
            break;
    }
    transform_mesh(mesh, object_transform(object));
    const auto found = std::find_if(materials.begin(), materials.end(),
                                    [&](const MaterialDescription& material) { return material.name == object.material; });
    mesh.material = static_cast<int>(found - materials.begin());
    meshes_.push_back(std::move(mesh));
}

}  // namespace opal
