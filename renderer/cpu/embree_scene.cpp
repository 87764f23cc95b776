// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/embree_scene.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <limits>

#include "formats/error.h"
#include "renderer/host/piece_bounds.h"

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

void bounds_of_piece(const RTCBoundsFunctionArguments* call) {
    const PieceBounds bounds = piece_bounds(static_cast<const MeshData*>(call->geometryUserPtr)->pieces[call->primID]);
    *call->bounds_o = {bounds.low[0], bounds.low[1], bounds.low[2], 0.0f, bounds.high[0], bounds.high[1], bounds.high[2], 0.0f};
}

/// Asked for one ray at a time.
PatchHit hit_on_piece(void* mesh, unsigned piece, const RTCRay& ray) {
    return meet_piece(static_cast<const MeshData*>(mesh)->pieces[piece],
                      {{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}}, ray.tfar);
}

void intersect_piece(const RTCIntersectFunctionNArguments* call) {
    if (call->valid[0] == 0) return;
    auto& query = *reinterpret_cast<RTCRayHit*>(call->rayhit);
    const PatchHit met = hit_on_piece(call->geometryUserPtr, call->primID, query.ray);
    if (!met.met) return;
    query.ray.tfar = met.distance_mm;
    query.hit.u = met.u;
    query.hit.v = met.v;
    query.hit.geomID = call->geomID;
    query.hit.primID = call->primID;
    query.hit.instID[0] = call->context->instID[0];
}

void occlude_by_piece(const RTCOccludedFunctionNArguments* call) {
    if (call->valid[0] == 0) return;
    auto& ray = *reinterpret_cast<RTCRay*>(call->ray);
    if (hit_on_piece(call->geometryUserPtr, call->primID, ray).met) ray.tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

RTCGeometry EmbreeScene::triangles(const MeshData& mesh) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Copied into Embree's own buffers: it reads 16 bytes at the last vertex.
    auto* positions = static_cast<std::array<float, 3>*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                        3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
    if (!positions || !indices) throw SystemError("Embree: out of memory");
    for (const Vec3& position : mesh.positions) *positions++ = {float(position.x), float(position.y), float(position.z)};
    std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
    return geometry;
}

RTCGeometry EmbreeScene::exact_surface(const MeshData& mesh) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(mesh.pieces.size()));
    rtcSetGeometryUserData(geometry, const_cast<MeshData*>(&mesh));
    rtcSetGeometryBoundsFunction(geometry, bounds_of_piece, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_piece);
    rtcSetGeometryOccludedFunction(geometry, occlude_by_piece);
    return geometry;
}

EmbreeScene::EmbreeScene(const std::vector<MeshData>& meshes) {
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw SystemError("Embree could not be started");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const MeshData& mesh : meshes) {
        RTCGeometry geometry = mesh.patches.empty() ? triangles(mesh) : exact_surface(mesh);
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

bool EmbreeScene::closest(const Ray& ray, RayHit& hit, float max_mm) const {
    RTCRayHit query;
    fill_ray(query.ray, ray);
    query.ray.tfar = max_mm;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = {query.ray.tfar, query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
    return true;
}

bool EmbreeScene::occluded(const Ray& ray, float max_mm) const {
    RTCRay query;
    fill_ray(query, ray);
    query.tfar = max_mm;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0.0f;
}

}  // namespace opal
