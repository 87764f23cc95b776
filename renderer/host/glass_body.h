// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/density_field.h"

namespace opal {

/// A transparent body of a dielectric material: to the transport an opal without lattice. Not movable: its view points inside.
class GlassBody {
  public:
    /// `bounds_mm`: of its mesh, object space. Throws InputError.
    GlassBody(const ObjectDescription& object, const MaterialDescription& material, const OpalDescription& settings,
              const openvdb::BBoxd& bounds_mm);
    GlassBody(const GlassBody&) = delete;
    GlassBody& operator=(const GlassBody&) = delete;

    const OpalView& view() const { return view_; }

  private:
    std::vector<float> index_, no_contrast_, equal_index_;
    std::vector<float> sigma_a_per_mm_, sigma_s_per_mm_;
    std::unique_ptr<DensityField> density_;
    OpalView view_;
};

}  // namespace opal
