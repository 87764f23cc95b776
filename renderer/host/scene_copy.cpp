// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/scene_copy.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace opal {
namespace {

void copy_table(const float*& table, ArrayCopier& copier) {
    table = copier.copy(table, spectrum_samples, "tables");
}

/// A NanoVDB grid is one block of memory without pointers.
template <class Grid>
void copy_grid(const Grid*& grid, ArrayCopier& copier, const char* what) {
    if (!grid) return;
    const auto* bytes = reinterpret_cast<const std::byte*>(grid);
    grid = reinterpret_cast<const Grid*>(copier.copy(bytes, std::size_t(grid->gridSize()), what));
}

void copy_spectra(SpectrumTables& spectra, ArrayCopier& copier) {
    spectra.observer = copier.copy(spectra.observer, spectrum_samples, "tables");
    copy_table(spectra.white, copier);
    spectra.rgb_basis = copier.copy(spectra.rgb_basis, spectrum_samples, "tables");
    copy_table(spectra.pdf, copier);
    copy_table(spectra.cdf, copier);
    spectra.smits = copier.copy(spectra.smits, smits_rows, "tables");
    spectra.alias.columns = copier.copy(spectra.alias.columns, std::size_t(spectra.alias.count), "tables");
}

void copy_environment(EnvironmentView& environment, ArrayCopier& copier) {
    const std::size_t width = std::size_t(environment.width), height = std::size_t(environment.height);
    environment.texels = copier.copy(environment.texels, width * height, "environment");
    environment.row_cdf = copier.copy(environment.row_cdf, height + 1, "environment");
    environment.column_cdf = copier.copy(environment.column_cdf, height * (width + 1), "environment");
}

void copy_lights(LightsView& lights, ArrayCopier& copier) {
    std::vector<LightView> views(lights.lights, lights.lights + lights.count);
    for (LightView& light : views) copy_table(light.radiance, copier);
    lights.lights = copier.copy(views.data(), views.size(), "lights");
}

void copy_grains(GrainsView& grains, ArrayCopier& copier) {
    copy_grid(grains.voxels.grid, copier, "grain voxels");
    CellField& cells = grains.cells;
    if (!cells.sites) return;
    const std::size_t sites = std::size_t(cells.num_sites);
    const std::size_t neighbors = cells.first[sites] + OPAL_CELL_LANES - 1;
    cells.sites = copier.copy(cells.sites, sites, "grain cells");
    cells.grain = copier.copy(cells.grain, sites, "grain cells");
    cells.first = copier.copy(cells.first, sites + 1, "grain cells");
    cells.neighbors = copier.copy(cells.neighbors, neighbors, "grain cells");
    const std::size_t boxes = std::size_t(cells.boxes[0]) * std::size_t(cells.boxes[1]) * std::size_t(cells.boxes[2]);
    cells.start_site = copier.copy(cells.start_site, boxes, "grain cells");
}

void copy_medium(MediumView& medium, ArrayCopier& copier) {
    copy_table(medium.sigma_a_per_mm, copier);
    copy_table(medium.sigma_s_mie_per_mm, copier);
    PhaseTableView& phase = medium.mie_phase.table;
    const std::size_t nodes = std::size_t(phase.num_nodes), all_nodes = nodes * std::size_t(phase.num_wavelengths);
    phase.cosine = copier.copy(phase.cosine, nodes, "phase functions");
    phase.density = copier.copy(phase.density, all_nodes, "phase functions");
    phase.cdf = copier.copy(phase.cdf, all_nodes, "phase functions");
    for (FieldView& field : medium.fields) copy_grid(field.grid, copier, "fields");
    MajorantView& majorants = medium.majorants;
    const std::size_t cells = std::size_t(majorants.size[0]) * std::size_t(majorants.size[1]) * std::size_t(majorants.size[2]);
    majorants.cells = copier.copy(majorants.cells, cells, "fields");
}

void copy_body(OpalView& body, ArrayCopier& copier) {
    copy_grains(body.grains, copier);
    copy_grid(body.shape.grid, copier, "level sets");
    body.orientations = copier.copy(body.orientations, std::size_t(body.num_grains), "grain orientations");
    body.grain_size_mm = copier.copy(body.grain_size_mm, std::size_t(body.num_grains), "grain orientations");
    for (const float** table : {&body.n_eff, &body.contrast, &body.relative_index, &body.surface_index})
        copy_table(*table, copier);
    copy_medium(body.medium, copier);
    const int* cells = body.guide.cells;
    const std::size_t guide = std::size_t(cells[0]) * std::size_t(cells[1]) * std::size_t(cells[2]) * guide_bins;
    body.guide.weight = copier.copy(body.guide.weight, guide, "light guides");
}

void copy_mesh(MeshView& mesh, ArrayCopier& copier) {
    mesh.positions = copier.copy(mesh.positions, mesh.num_vertices, "meshes");
    mesh.normals = copier.copy(mesh.normals, mesh.num_vertices, "meshes");
    mesh.indices = copier.copy(mesh.indices, 3 * std::size_t(mesh.num_triangles), "meshes");
    mesh.patches.patches = copier.copy(mesh.patches.patches, mesh.patches.num_patches, "exact surfaces");
    mesh.patches.pieces = copier.copy(mesh.patches.pieces, mesh.patches.num_pieces, "exact surfaces");
}

void copy_material(MaterialView& material, ArrayCopier& copier) {
    copy_table(material.index, copier);
    copy_table(material.extinction, copier);
    CoatAlbedoView& coat = material.coat_albedo;
    const std::size_t count = std::size_t(coat.count);
    coat.eta = copier.copy(coat.eta, count, "materials");
    coat.value = copier.copy(coat.value, count * coat_albedo_samples, "materials");
    coat.mean = copier.copy(coat.mean, count, "materials");
}

/// Copies what the views of a list point to, then the list itself.
template <class View>
void copy_views(const View*& views, int count, void (*copy_view)(View&, ArrayCopier&), ArrayCopier& copier, const char* what) {
    std::vector<View> list(views, views + count);
    for (View& view : list) copy_view(view, copier);
    views = copier.copy(list.data(), list.size(), what);
}

/// Copies nothing and adds up.
class Adder : public ArrayCopier {
  public:
    SceneMemory memory;

  private:
    const void* copy_bytes(const void* data, std::size_t bytes, const char* what) override {
        auto found = std::find_if(memory.items.begin(), memory.items.end(), [&](const auto& item) { return item.what == what; });
        if (found == memory.items.end()) found = memory.items.insert(found, {what, 0});
        found->bytes += bytes;
        return data;
    }
};

}  // namespace

const void* HostArrayCopier::copy_bytes(const void* data, std::size_t bytes, const char*) {
    constexpr std::size_t alignment = 64;
    void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (!memory) throw std::bad_alloc();
    arrays_.emplace_back(memory, &std::free);
    total_bytes_ += bytes;
    return std::memcpy(memory, data, bytes);
}

SceneView copied_scene(const SceneView& scene, ArrayCopier& copier) {
    SceneView copy = scene;
    copy_spectra(copy.spectra, copier);
    copy_environment(copy.environment, copier);
    copy_lights(copy.lights, copier);
    copy_views(copy.bodies, copy.num_bodies, copy_body, copier, "bodies");
    copy_views(copy.meshes, copy.num_meshes, copy_mesh, copier, "meshes");
    copy_views(copy.materials, copy.num_materials, copy_material, copier, "materials");
    return copy;
}

std::size_t SceneMemory::total_bytes() const {
    std::size_t total = 0;
    for (const Item& item : items) total += item.bytes;
    return total;
}

SceneMemory scene_memory(const SceneView& scene) {
    Adder adder;
    copied_scene(scene, adder);
    return adder.memory;
}

}  // namespace opal
