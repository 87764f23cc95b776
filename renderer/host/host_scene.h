// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/command.h"
#include "formats/scene.h"
#include "renderer/core/scene_view.h"
#include "renderer/host/environment_map.h"
#include "renderer/host/glass_body.h"
#include "renderer/host/light_data.h"
#include "renderer/host/material_data.h"
#include "renderer/host/mesh_data.h"
#include "renderer/host/opal_cache.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {

/// Everything a scene needs in memory, and the plain view of it that the transport reads. Not movable: the view points inside.
class HostScene {
  public:
    /// Loads all that the description names, but for opals that `opals` knows. Throws InputError. Notices for the user are
    /// appended to `notices`.
    HostScene(const SceneDescription& description, std::vector<std::string>& notices, OpalCache* opals = nullptr);
    HostScene(const HostScene&) = delete;
    HostScene& operator=(const HostScene&) = delete;

    const SceneView& view() const { return view_; }
    const std::vector<MeshData>& meshes() const { return meshes_; }
    const EnvironmentMap& environment() const { return environment_; }
    std::size_t num_bodies() const { return bodies_.size(); }
    /// Whether scattered light is to be drawn towards where light comes from.
    bool guided() const { return guided_; }

    /// What preparing the tables of light, colours and spectra took.
    double tables_seconds() const { return tables_s_; }

    /// Of the opal that has most; see OpalBody.
    int reciprocal_points() const;
    /// Of all opals together.
    std::size_t num_grains() const;
    const std::vector<std::shared_ptr<const OpalBody>>& opals() const { return opals_; }
    /// Of the first opal; empty without one, and for files made elsewhere.
    const std::string& recipe_toml() const;

  private:
    /// `description`: about the place `origin_mm` of the scene.
    HostScene(const SceneDescription& description, const std::array<double, 3>& origin_mm, std::vector<std::string>& notices,
              OpalCache* opals);
    void add_opal(const ObjectDescription& object, std::shared_ptr<const OpalBody> opal);
    void add_body(const OpalView& view, int priority);
    void order_bodies();
    void place_camera(const RenderDescription& render);
    void add_mesh(const ObjectDescription& object, const SceneDescription& scene, std::vector<std::string>& notices);
    void add_glass(const ObjectDescription& object, const MaterialDescription& material, const OpalDescription& settings,
                   MeshData mesh);
    void require_lights_outside(const std::vector<LightDescription>& lights, const std::array<double, 3>& origin_mm) const;

    const Stopwatch watch_;
    EnvironmentMap environment_;
    LightData lights_;
    SpectrumTablesData spectra_;
    std::vector<MaterialData> material_data_;
    std::vector<MaterialView> materials_;
    std::vector<MeshData> meshes_;
    std::vector<MeshView> mesh_views_;
    std::vector<std::shared_ptr<const OpalBody>> opals_;
    std::vector<std::unique_ptr<GlassBody>> glasses_;
    std::vector<OpalView> bodies_;
    std::vector<int> priorities_;  ///< of the bodies, in the scene's order
    bool guided_;
    SceneView view_;
    double tables_s_ = 0.0;
};

/// The camera of a description for a picture of the given size.
Camera make_camera(const CameraDescription& description, int width, int height);

}  // namespace opal
