// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/field_grid.h"
#include "renderer/host/grain_source.h"
#include "renderer/host/medium_fields.h"
#include "renderer/host/mesh_data.h"
#include "renderer/host/phase_function.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {

/// The opal's optical constants in steps of 1 nm.
struct OpticalTables {
    std::vector<float> n_eff, contrast, relative_index, surface_index;
    bool surface_disperses = false;
};

/// Everything a scene needs in memory, and the plain view of it that the transport reads. Not movable: the view points inside.
class HostScene {
  public:
    /// Loads all that the description names. Throws InputError. Notices for the user are appended to `notices`.
    HostScene(const SceneDescription& description, std::vector<std::string>& notices);
    HostScene(const HostScene&) = delete;
    HostScene& operator=(const HostScene&) = delete;

    const SceneView& view() const { return view_; }
    const std::vector<MeshData>& meshes() const { return meshes_; }
    const EnvironmentMap& environment() const { return environment_; }

    /// Reciprocal-lattice points inside the limiting sphere, the origin counted; 0 without an opal.
    int reciprocal_points() const { return reciprocal_points_; }
    std::size_t num_grains() const { return orientations_.size(); }
    /// Null without an opal.
    const GrainSource* grains() const { return grains_.get(); }
    /// The recipe that the opal's file carries; empty for files made elsewhere.
    const std::string& recipe_toml() const { return recipe_toml_; }

  private:
    void add_opal(const ObjectDescription& object, const OpalDescription& settings, std::vector<std::string>& notices);
    void add_mesh(const ObjectDescription& object, const std::vector<MaterialDescription>& materials);

    SpectrumTablesData spectra_;
    EnvironmentMap environment_;
    std::vector<DiffuseMaterial> materials_;
    std::vector<MeshData> meshes_;
    std::vector<MeshView> mesh_views_;
    std::unique_ptr<GrainSource> grains_;
    std::vector<Quaternion> orientations_;
    OpticalTables optics_;
    std::vector<float> sigma_a_per_mm_, sigma_s_mie_per_mm_;
    std::unique_ptr<FieldGridData> shape_;
    std::unique_ptr<MediumFields> medium_fields_;
    PhaseFunction mie_phase_;
    int reciprocal_points_ = 0;
    std::string recipe_toml_;
    SceneView view_;
};

/// The camera of a description for a picture of the given size.
Camera make_camera(const CameraDescription& description, int width, int height);

}  // namespace opal
