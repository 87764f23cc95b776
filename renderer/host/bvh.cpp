// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/bvh.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>

#include "formats/error.h"
#include "renderer/host/piece_bounds.h"

namespace opal {
namespace {

constexpr std::uint32_t triangles_per_leaf = 4;
static_assert(triangles_per_leaf <= bvh_max_leaf);

struct DeviceRelease {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct TreeRelease {
    void operator()(RTCBVH tree) const { rtcReleaseBVH(tree); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using TreeHandle = std::unique_ptr<RTCBVHTy, TreeRelease>;

/// What the builder hangs together, in memory of its own.
struct BuildNode {
    std::uint32_t num_primitives = 0;                                         ///< of a leaf; 0 where it has children
    std::array<std::array<std::uint32_t, 2>, triangles_per_leaf> primitives;  ///< mesh and index
    std::array<BuildNode*, 2> children;
    std::array<RTCBounds, 2> bounds;
};

void* create_node(RTCThreadLocalAllocator memory, unsigned, void*) {
    return new (rtcThreadLocalAlloc(memory, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
}

void set_children(void* node, void** children, unsigned, void*) {
    for (std::size_t i = 0; i < 2; ++i) static_cast<BuildNode*>(node)->children[i] = static_cast<BuildNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned, void*) {
    for (std::size_t i = 0; i < 2; ++i) static_cast<BuildNode*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator memory, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    auto* leaf = new (rtcThreadLocalAlloc(memory, sizeof(BuildNode), alignof(BuildNode))) BuildNode;
    leaf->num_primitives = std::uint32_t(count);
    for (std::size_t i = 0; i < count; ++i) leaf->primitives[i] = {primitives[i].geomID, primitives[i].primID};
    return leaf;
}

RTCBuildPrimitive build_primitive(const BvhPrimitive& primitive, const MeshData& mesh) {
    RTCBuildPrimitive result;
    result.geomID = primitive.mesh;
    result.primID = primitive.index;
    if (primitive.is_piece != 0) {
        const PieceBounds bounds = piece_bounds(mesh.pieces[primitive.index]);
        result.lower_x = bounds.low[0], result.lower_y = bounds.low[1], result.lower_z = bounds.low[2];
        result.upper_x = bounds.high[0], result.upper_y = bounds.high[1], result.upper_z = bounds.high[2];
        return result;
    }
    const Vec3 a = primitive.corner[0], b = primitive.corner[1], c = primitive.corner[2];
    result.lower_x = std::min({a.x, b.x, c.x}), result.upper_x = std::max({a.x, b.x, c.x});
    result.lower_y = std::min({a.y, b.y, c.y}), result.upper_y = std::max({a.y, b.y, c.y});
    result.lower_z = std::min({a.z, b.z, c.z}), result.upper_z = std::max({a.z, b.z, c.z});
    return result;
}

BvhPrimitive bvh_primitive(const std::vector<MeshData>& meshes, std::uint32_t mesh, std::uint32_t index) {
    const MeshData& data = meshes[mesh];
    BvhPrimitive primitive{{}, mesh, index, data.patches.empty() ? 0u : 1u};
    if (primitive.is_piece == 0)
        for (std::size_t i = 0; i < 3; ++i) primitive.corner[i] = data.positions[data.indices[3 * std::size_t(index) + i]];
    return primitive;
}

std::vector<RTCBuildPrimitive> build_primitives(const std::vector<MeshData>& meshes) {
    std::size_t total = 0;
    for (const MeshData& mesh : meshes) total += mesh.patches.empty() ? mesh.indices.size() / 3 : mesh.pieces.size();
    if (total > BvhChild::bvh_max_index)
        throw InputError(
            fmt::format("the scene's meshes have {} triangles; at most {} are possible", total, BvhChild::bvh_max_index));
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(total);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const std::size_t count = meshes[m].patches.empty() ? meshes[m].indices.size() / 3 : meshes[m].pieces.size();
        for (std::size_t i = 0; i < count; ++i)
            primitives.push_back(build_primitive(bvh_primitive(meshes, std::uint32_t(m), std::uint32_t(i)), meshes[m]));
    }
    return primitives;
}

/// The builder's tree as flat arrays, every node before its children.
class Flattening {
  public:
    Flattening(const std::vector<MeshData>& meshes, std::vector<BvhNode>& nodes, std::vector<BvhPrimitive>& primitives)
        : meshes_(meshes), nodes_(nodes), primitives_(primitives) {}

    BvhChild add(const BuildNode& node, int level) {
        if (node.num_primitives > 0) {
            const BvhChild leaf = BvhChild::of_leaf(std::uint32_t(primitives_.size()), node.num_primitives);
            for (std::uint32_t i = 0; i < node.num_primitives; ++i)
                primitives_.push_back(bvh_primitive(meshes_, node.primitives[i][0], node.primitives[i][1]));
            return leaf;
        }
        depth_ = std::max(depth_, level + 1);
        const std::size_t place = nodes_.size();
        nodes_.emplace_back();
        for (std::size_t i = 0; i < 2; ++i) {
            const RTCBounds& bounds = node.bounds[i];
            nodes_[place].low[i] = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
            nodes_[place].high[i] = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
            const BvhChild child = add(*node.children[i], level + 1);
            nodes_[place].child[i] = child;
        }
        return BvhChild::of_node(std::uint32_t(place));
    }
    int depth() const { return depth_; }

  private:
    const std::vector<MeshData>& meshes_;
    std::vector<BvhNode>& nodes_;
    std::vector<BvhPrimitive>& primitives_;
    int depth_ = 0;
};

RTCBuildArguments build_arguments(RTCBVH tree, std::vector<RTCBuildPrimitive>& primitives, bool has_pieces) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;  // without spatial splits: a primitive is in one leaf
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = bvh_max_depth;
    // A patch takes far longer than the bounds that may spare it.
    arguments.maxLeafSize = has_pieces ? 1 : triangles_per_leaf;
    arguments.bvh = tree;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    return arguments;
}

}  // namespace

Bvh::Bvh(const std::vector<MeshData>& meshes) {
    std::vector<RTCBuildPrimitive> primitives = build_primitives(meshes);
    if (primitives.empty()) return;
    for (const RTCBuildPrimitive& p : primitives)
        reach_mm_ = std::max({reach_mm_, -p.lower_x, -p.lower_y, -p.lower_z, p.upper_x, p.upper_y, p.upper_z});
    const DeviceHandle device(rtcNewDevice(nullptr));
    if (!device) throw SystemError("Embree could not be started");
    const TreeHandle tree(rtcNewBVH(device.get()));
    has_pieces_ = std::any_of(meshes.begin(), meshes.end(), [](const MeshData& mesh) { return !mesh.patches.empty(); });
    const RTCBuildArguments arguments = build_arguments(tree.get(), primitives, has_pieces_);
    void* root = nullptr;
    // By one thread, so that the order of primitives in a leaf, and with it that of ties, does not depend on how many cores there
    // are.
    tbb::task_arena(1).execute([&] { root = rtcBuildBVH(&arguments); });
    if (!root) throw SystemError("Embree could not build a hierarchy of bounds");
    primitives_.reserve(primitives.size());
    Flattening flattening(meshes, nodes_, primitives_);
    root_ = flattening.add(*static_cast<const BuildNode*>(root), 0);
    depth_ = flattening.depth();
    if (depth_ > bvh_max_depth) throw SystemError(fmt::format("Embree built a hierarchy of {} levels", depth_));
}

}  // namespace opal
