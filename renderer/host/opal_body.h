// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/grain_source.h"
#include "renderer/host/medium_fields.h"
#include "renderer/host/mesh_data.h"
#include "renderer/host/phase_function.h"

namespace opal {

/// The opal's optical constants in steps of 1 nm.
struct OpticalTables {
    std::vector<float> n_eff, contrast, relative_index, surface_index;
    bool surface_disperses = false;
};

/// One opal in memory, wherever scenes have it. Not movable: its view points inside.
class OpalBody {
  public:
    /// Loads the object's file; of where the object stands nothing is kept but its scale. Throws InputError. Notices for the user
    /// are appended to `notices`.
    OpalBody(const ObjectDescription& object, const OpalDescription& settings, std::vector<std::string>& notices);
    OpalBody(const OpalBody&) = delete;
    OpalBody& operator=(const OpalBody&) = delete;

    /// As a body that stands there; the scale must be the object's.
    OpalView placed(const RigidTransform& world_from_object) const {
        OpalView view = view_;
        view.world_from_object = world_from_object;
        return view;
    }
    /// The surface in world space: one closed mesh, or one for each part of an exact surface.
    std::vector<MeshData> surfaces(const RigidTransform& world_from_object) const;

    /// Reciprocal-lattice points inside the limiting sphere, the origin counted.
    int reciprocal_points() const { return reciprocal_points_; }
    std::size_t num_grains() const { return orientations_.size(); }
    const GrainSource& grains() const { return *grains_; }
    /// The recipe that the file carries; empty for files made elsewhere.
    const std::string& recipe_toml() const { return recipe_toml_; }

  private:
    MeshData surface_;                  ///< object space; not used where there are patches
    std::vector<BezierPatch> patches_;  ///< of an exact surface
    std::unique_ptr<GrainSource> grains_;
    std::vector<Quaternion> orientations_;
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
