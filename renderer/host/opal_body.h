// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/grain_grid.h"
#include "renderer/host/medium_fields.h"
#include "renderer/host/mesh_data.h"
#include "renderer/host/phase_function.h"

namespace opal {

/// The opal's optical constants in steps of 1 nm.
struct OpticalTables {
    std::vector<float> n_eff, contrast, relative_index, surface_index;
    bool surface_disperses = false;
};

/// One opal of a scene in memory. Not movable: its view points inside.
class OpalBody {
  public:
    /// Loads the object's file. Throws InputError. Notices for the user are appended to `notices`.
    OpalBody(const ObjectDescription& object, const OpalDescription& settings, std::vector<std::string>& notices);
    OpalBody(const OpalBody&) = delete;
    OpalBody& operator=(const OpalBody&) = delete;

    const OpalView& view() const { return view_; }
    /// Hands over the surface in world space.
    MeshData take_surface() { return std::move(surface_); }

    /// Reciprocal-lattice points inside the limiting sphere, the origin counted.
    int reciprocal_points() const { return reciprocal_points_; }
    std::size_t num_grains() const { return orientations_.size(); }
    /// The recipe that the file carries; empty for files made elsewhere.
    const std::string& recipe_toml() const { return recipe_toml_; }

  private:
    MeshData surface_;
    std::unique_ptr<GrainGridData> grains_;
    std::vector<Quaternion> orientations_;
    std::vector<float> grain_size_mm_;
    OpticalTables optics_;
    std::vector<float> sigma_a_per_mm_, sigma_s_mie_per_mm_;
    std::unique_ptr<FieldGridData> shape_;
    std::unique_ptr<MediumFields> medium_fields_;
    PhaseFunction mie_phase_;
    int reciprocal_points_ = 0;
    std::string recipe_toml_;
    OpalView view_;
};

}  // namespace opal
