// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/cpu/embree_scene.h"
#include "renderer/host/host_scene.h"

namespace opal {

/// Learns, before a render, where light comes from inside the bodies that scatter: photons from all lights, counted in integers,
/// so that the order in which threads come does not matter. A pure function of the scene; without guides where the scene wants
/// none.
class LightGuides {
  public:
    LightGuides(const HostScene& scene, const EmbreeScene& intersector);
    LightGuides(const LightGuides&) = delete;
    LightGuides& operator=(const LightGuides&) = delete;

    /// The scene with the guides in its bodies; it points into this object.
    const SceneView& scene() const { return view_; }

  private:
    std::vector<OpalView> bodies_;
    std::vector<std::vector<float>> weights_;  ///< of the bodies that have one
    SceneView view_;
};

}  // namespace opal
