// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "formats/material.h"
#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/coat_albedo.h"

namespace opal {

/// Owns what the view of an opaque material points to.
class MaterialData {
  public:
    /// `dispersion` none: the plastic's index at 589.3 nm. Throws InputError. A dielectric gives a view of no use.
    MaterialData(const MaterialDescription& material, UpsamplingMethod upsampling, Dispersion dispersion);

    /// Makes a rough coat ready to be met from the open and from inside `bodies`.
    void prepare_coat(std::span<const OpalView> bodies);

    /// Valid while this object stays where it is and until its coat is prepared anew.
    MaterialView view() const;

  private:
    MaterialModel model_ = MaterialModel::diffuse;
    UpsampledColor albedo_;
    float roughness_ = 0.0f;
    std::vector<float> index_, extinction_;
    CoatAlbedo coat_;
};

}  // namespace opal
