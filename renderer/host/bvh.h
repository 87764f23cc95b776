// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/core/bvh_view.h"
#include "renderer/host/mesh_data.h"

namespace opal {

/// Owns a hierarchy of bounds over the scene's triangles and patches, as its traversal reads it on host and devices. The same for
/// the same meshes, on however many cores.
class Bvh {
  public:
    /// Built by Embree's builder, with the surface area heuristic. Throws InputError where there are more primitives than nodes
    /// can tell apart.
    explicit Bvh(const std::vector<MeshData>& meshes);

    BvhChild root() const { return root_; }
    float reach_mm() const { return reach_mm_; }  ///< largest coordinate of the bounds
    const std::vector<BvhNode>& nodes() const { return nodes_; }
    const std::vector<BvhPrimitive>& primitives() const { return primitives_; }
    int depth() const { return depth_; }             ///< levels of nodes
    bool has_pieces() const { return has_pieces_; }  ///< of patches

    /// `meshes`: views of the meshes that it was built from; they and this must outlive it. `with_pieces`: false only where there
    /// are none.
    template <bool with_pieces>
    BvhView<with_pieces> view(const MeshView* meshes) const {
        return {root_, reach_mm_, nodes_.data(), primitives_.data(), std::uint32_t(primitives_.size()), meshes};
    }

  private:
    BvhChild root_;
    float reach_mm_ = 0.0f;
    std::vector<BvhNode> nodes_;
    std::vector<BvhPrimitive> primitives_;
    int depth_ = 0;
    bool has_pieces_ = false;
};

}  // namespace opal
