// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <limits>
#include <vector>

#include "renderer/core/scene_view.h"
#include "renderer/host/mesh_data.h"

namespace opal {

/// Rays against the scene's triangles and patches on the CPU. Safe to use from many threads.
class EmbreeScene {
  public:
    /// The meshes must outlive the object.
    explicit EmbreeScene(const std::vector<MeshData>& meshes);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Nearest surface along the ray.
    bool closest(const Ray& ray, RayHit& hit, float max_mm = std::numeric_limits<float>::infinity()) const;
    /// Whether anything lies along the ray within `max_mm`.
    bool occluded(const Ray& ray, float max_mm) const;

  private:
    RTCGeometry triangles(const MeshData& mesh) const;
    RTCGeometry exact_surface(const MeshData& mesh) const;

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

}  // namespace opal
