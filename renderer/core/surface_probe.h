// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/scene_view.h"

namespace opal {

/// What is ahead of a ray, a surface or a light, looked for when it is first asked for.
template <class Intersector>
class SurfaceProbe {
  public:
    /// `direct`: the ray comes straight from the camera.
    OPAL_HD SurfaceProbe(const Intersector& intersector, const LightsView& lights, const Ray& ray, bool direct)
        : intersector_(intersector), lights_(lights), ray_(ray), direct_(direct) {}

    OPAL_HD bool found() {
        if (asked_) return found_;
        asked_ = true;
        found_ = intersector_.closest(ray_, hit_);
        meets_light_ = intersect_lights(lights_, ray_, found_ ? hit_.distance_mm : 3.0e38f, direct_, light_);
        found_ = found_ || meets_light_;
        return found_;
    }
    /// 0 where there is nothing.
    OPAL_HD float distance_mm() { return !found() ? 0.0f : (meets_light_ ? light_.distance_mm : hit_.distance_mm); }
    /// Once found: whether it is a light, and which; else the surface.
    OPAL_HD bool meets_light() const { return meets_light_; }
    OPAL_HD const LightHit& light() const { return light_; }
    OPAL_HD const RayHit& hit() const { return hit_; }

  private:
    const Intersector& intersector_;
    const LightsView& lights_;
    const Ray& ray_;
    RayHit hit_;
    LightHit light_;
    bool direct_;
    bool asked_ = false;
    bool found_ = false;
    bool meets_light_ = false;
};

}  // namespace opal
