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
        return settle(intersector_.closest(ray_, hit_));
    }
    /// 0 where there is nothing.
    OPAL_HD real distance_mm() { return !found() ? 0.0f : (meets_light_ ? light_.distance_mm : hit_.distance_mm); }
    /// The same for a ray inside a body, which holds no lights, where only what lies within `within_mm` matters: 3e38 where
    /// nothing does. A short ray costs less than one to the far side; where one was not enough, the next goes all the way.
    OPAL_HD real distance_mm(real within_mm) {
        if (asked_) return distance_mm();
        if (within_mm <= clear_mm_) return 3.0e38f;
        if (clear_mm_ > 0.0f) return distance_mm();
        if (intersector_.closest(ray_, hit_, within_mm)) {
            settle(true);
            return distance_mm();
        }
        clear_mm_ = within_mm;
        return 3.0e38f;
    }
    /// Once found: whether it is a light, and which; else the surface.
    OPAL_HD bool meets_light() const { return meets_light_; }
    OPAL_HD const LightHit& light() const { return light_; }
    OPAL_HD const RayHit& hit() const { return hit_; }

  private:
    OPAL_HD bool settle(bool meets_surface) {
        asked_ = true;
        found_ = meets_surface;
        meets_light_ = intersect_lights(lights_, ray_, found_ ? hit_.distance_mm : 3.0e38f, direct_, light_);
        found_ = found_ || meets_light_;
        return found_;
    }
    const Intersector& intersector_;
    const LightsView& lights_;
    const Ray& ray_;
    RayHit hit_;
    LightHit light_;
    real clear_mm_ = 0.0f;  ///< nothing lies within
    bool direct_;
    bool asked_ = false;
    bool found_ = false;
    bool meets_light_ = false;
};

}  // namespace opal
