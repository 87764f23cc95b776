// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/embree_scene.h"

#include <tbb/task_arena.h>

#include <cmath>
#include <limits>

#include "formats/error.h"

namespace opal {
namespace {

void fill_ray(RTCRay& target, const Ray& ray) {
    target.org_x = ray.origin.x;
    target.org_y = ray.origin.y;
    target.org_z = ray.origin.z;
    target.dir_x = ray.direction.x;
    target.dir_y = ray.direction.y;
    target.dir_z = ray.direction.z;
    target.tnear = 0.0f;
    target.tfar = std::numeric_limits<float>::infinity();
    target.time = 0.0f;
    target.mask = 0xFFFFFFFFu;
    target.id = 0;
    target.flags = 0;
}

}  // namespace

EmbreeScene::EmbreeScene(const std::vector<MeshData>& meshes) : meshes_(meshes) {
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw SystemError("Embree could not be started");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const MeshData& mesh : meshes) {
        exact_ = exact_ || !mesh.patches.empty();
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Copied into Embree's own buffers: it reads 16 bytes at the last vertex.
        auto* positions = static_cast<Vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                            3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
        if (!positions || !indices) throw SystemError("Embree: out of memory");
        std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
        std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    // Built by one thread: the tree, and with it the order in which ties are met, must not depend on how many cores there are.
    // (Embree's own thread limit would hold for the whole process.)
    tbb::task_arena(1).execute([&] { rtcCommitScene(scene_); });
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw SystemError("Embree could not build the scene");
}

EmbreeScene::~EmbreeScene() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

bool EmbreeScene::closest(const Ray& ray, RayHit& hit) const {
    float nearest_mm = 0.0f;
    while (true) {
        RTCRayHit query;
        fill_ray(query.ray, ray);
        query.ray.tnear = nearest_mm;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        hit = {query.ray.tfar, query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
        const MeshData& mesh = meshes_[hit.mesh];
        if (mesh.patches.empty()) return true;
        const PatchHit exact = hit_on_patch(mesh.patch_view(), mesh.indices.data() + 3 * std::size_t(hit.triangle), ray,
                                            hit.triangle, {hit.u, hit.v, hit.distance_mm, true});
        if (exact.met) {
            hit.u = exact.u;
            hit.v = exact.v;
            hit.distance_mm = exact.distance_mm;
            return true;
        }
        // The triangle is not the surface: on behind it.
        nearest_mm = std::nextafter(hit.distance_mm * (1.0f + 1.0e-6f), std::numeric_limits<float>::infinity());
    }
}

bool EmbreeScene::occluded(const Ray& ray, float max_mm) const {
    if (exact_) {
        RayHit hit;
        return closest(ray, hit) && hit.distance_mm < max_mm;
    }
    RTCRay query;
    fill_ray(query, ray);
    query.tfar = max_mm;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0.0f;
}

}  // namespace opal
