// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/scene_view.h"
#include "renderer/core/triangle_hit.h"

/// A hierarchy of bounds over the scene's triangles and patches, for machines without Embree.
namespace opal {

/// No more levels than this are in any hierarchy: a walk needs to remember one box per level.
inline constexpr int bvh_max_depth = 64;
inline constexpr uint32_t bvh_max_leaf = 8;

/// What a node's child is: another node, or a leaf's run of primitives.
struct BvhChild {
    uint32_t bits = 0;

    OPAL_HD static BvhChild of_node(uint32_t node) { return {node}; }
    OPAL_HD static BvhChild of_leaf(uint32_t first, uint32_t count) { return {0x80000000u | (count - 1) << 28 | first}; }
    OPAL_HD bool is_leaf() const { return bits >> 31 != 0; }
    OPAL_HD uint32_t node() const { return bits; }
    OPAL_HD uint32_t first() const { return bits & bvh_max_index; }
    OPAL_HD uint32_t count() const { return (bits >> 28 & 7u) + 1; }

    static constexpr uint32_t bvh_max_index = 0x0FFFFFFFu;
};

/// Two children with their bounds: half a cache line of a host, two of a device's sectors.
struct alignas(64) BvhNode {
    Vec3 low[2], high[2];
    BvhChild child[2];
};

/// A triangle with its corners, or a piece of a patch.
struct alignas(16) BvhPrimitive {
    Vec3 corner[3];  ///< of a triangle
    uint32_t mesh;
    uint32_t index;     ///< of the triangle or piece in its mesh
    uint32_t is_piece;  ///< 0 or 1
};

/// A ray against bounds, never missing what its triangles would be met in. Places in the ray's sheared frame are rounded by up to
/// 4 half-ulps of the distance from the origin, and a slab's distances by as much as moving it by another 4 (Ize 2013, "Robust
/// BVH ray traversal"): bounds are widened by 16 half-ulps of the largest coordinates.
class RayBounds {
  public:
    /// `reach_mm`: largest coordinate of the bounds.
    OPAL_HD RayBounds(const Ray& ray, real reach_mm) {
        const real room_mm = 0x1p-20f * (max_abs(ray.origin) + reach_mm);
        const Vec3 room{room_mm, room_mm, room_mm};
        below_ = ray.origin + room;
        above_ = ray.origin - room;
        inverse_ = {inverse_of(ray.direction.x), inverse_of(ray.direction.y), inverse_of(ray.direction.z)};
    }

    /// Whether the ray is in the bounds somewhere from 0 to `max_mm`, and from where on.
    OPAL_HD bool meets(Vec3 low, Vec3 high, real max_mm, real& enters_mm) const {
        const Vec3 a{(low.x - below_.x) * inverse_.x, (low.y - below_.y) * inverse_.y, (low.z - below_.z) * inverse_.z};
        const Vec3 b{(high.x - above_.x) * inverse_.x, (high.y - above_.y) * inverse_.y, (high.z - above_.z) * inverse_.z};
        enters_mm = max_of(max_of(min_of(a.x, b.x), min_of(a.y, b.y)), max_of(min_of(a.z, b.z), 0.0f));
        const real leaves_mm = min_of(min_of(max_of(a.x, b.x), max_of(a.y, b.y)), min_of(max_of(a.z, b.z), max_mm));
        return enters_mm <= leaves_mm;
    }

  private:
    /// Finite, so that 0 times it is 0: a ray across an axis that starts on a face of the bounds is in them.
    OPAL_HD static real inverse_of(real component) {
        constexpr real least = 1.0e-18f;
        return 1.0f / (fabs(component) < least ? copysign(least, component) : component);
    }

    Vec3 below_, above_, inverse_;
};

/// The hierarchy, and rays against it: an Intersector of the path tracer. `with_pieces`: some primitives are pieces of patches;
/// without them a device's thread needs a twentieth of the memory.
template <bool with_pieces>
class BvhView {
  public:
    BvhView() = default;
    OPAL_HD BvhView(BvhChild root, real reach_mm, const BvhNode* nodes, const BvhPrimitive* primitives, uint32_t num_primitives,
                    const MeshView* meshes)
        : root_(root),
          reach_mm_(reach_mm),
          nodes_(nodes),
          primitives_(primitives),
          num_primitives_(num_primitives),
          meshes_(meshes) {}

    /// Nearest surface along the ray, within `max_mm`.
    OPAL_HD bool closest(const Ray& ray, RayHit& hit, real max_mm = INFINITY) const { return walk<false>(ray, max_mm, hit); }
    /// Whether anything lies along the ray within `max_mm`.
    OPAL_HD bool occluded(const Ray& ray, real max_mm) const {
        RayHit hit;
        return walk<true>(ray, max_mm, hit);
    }

  private:
    struct Waiting {
        BvhChild child;
        real enters_mm;
    };

    /// Nearer children first; ends with the first hit where any will do.
    template <bool any>
    OPAL_HD bool walk(const Ray& ray, real nearest_mm, RayHit& hit) const {
        if (num_primitives_ == 0) return false;
        const RayBounds bounds(ray, reach_mm_);
        const RayFrame frame(ray);
        Waiting waiting[bvh_max_depth];
        int count = 0;
        bool met = false;
        for (BvhChild at = root_;;) {
            if (at.is_leaf()) {
                const uint32_t end = at.first() + at.count();
                for (uint32_t i = at.first(); i < end; ++i)
                    if (meet(primitives_[i], ray, frame, nearest_mm, hit)) {
                        if (any) return true;
                        met = true;
                    }
            } else {
                const BvhNode& node = nodes_[at.node()];
                real first_mm, second_mm;
                const bool first = bounds.meets(node.low[0], node.high[0], nearest_mm, first_mm);
                const bool second = bounds.meets(node.low[1], node.high[1], nearest_mm, second_mm);
                if (first && second) {
                    const bool swap = second_mm < first_mm;
                    waiting[count++] = {swap ? node.child[0] : node.child[1], swap ? first_mm : second_mm};
                    at = swap ? node.child[1] : node.child[0];
                    continue;
                }
                if (first || second) {
                    at = first ? node.child[0] : node.child[1];
                    continue;
                }
            }
            do {
                if (count == 0) return met;
                --count;
            } while (waiting[count].enters_mm > nearest_mm);
            at = waiting[count].child;
        }
    }

    /// Shortens `nearest_mm` to a hit.
    OPAL_HD bool meet(const BvhPrimitive& primitive, const Ray& ray, const RayFrame& frame, real& nearest_mm, RayHit& hit) const {
        if (with_pieces && primitive.is_piece != 0) {
            const PatchHit on_piece = meet_piece(meshes_[primitive.mesh].patches.pieces[primitive.index], ray, nearest_mm);
            if (!on_piece.met) return false;
            nearest_mm = on_piece.distance_mm;
            hit = {nearest_mm, primitive.mesh, primitive.index, on_piece.u, on_piece.v};
            return true;
        }
        const TriangleHit on_triangle = frame.meet(primitive.corner[0], primitive.corner[1], primitive.corner[2], nearest_mm);
        if (!on_triangle.met) return false;
        nearest_mm = on_triangle.distance_mm;
        hit = {nearest_mm, primitive.mesh, primitive.index, on_triangle.u, on_triangle.v};
        return true;
    }

    BvhChild root_;
    real reach_mm_ = 0.0f;
    const BvhNode* nodes_ = nullptr;
    const BvhPrimitive* primitives_ = nullptr;
    uint32_t num_primitives_ = 0;
    const MeshView* meshes_ = nullptr;
};

}  // namespace opal
