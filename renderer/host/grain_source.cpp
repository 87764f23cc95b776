// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/grain_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/error.h"
#include "formats/recipe_names.h"

namespace opal {
namespace {

/// Why the sites of a file are no cells to be walked; empty where they are.
std::string obstacle_to_cells(const OpalAsset& asset) {
    if (asset.sites.empty()) return "the file holds no sites";
    if (std::none_of(asset.sites.begin(), asset.sites.end(), [](const Site& site) { return site.grain > 0; }))
        return "no site of the file owns anything";
    if (asset.tessellation != TessellationKind::additive && asset.tessellation != TessellationKind::voronoi)
        return fmt::format("the cells of a {} tessellation are of another kind",
                           recipe_names::name(recipe_names::tessellations, asset.tessellation));
    if (asset.boundary_noise.amplitude_mm > 0.0) return "boundary noise displaces the boundaries of the cells";
    return "";
}

GrainMethod method_of(GrainsKind kind) {
    switch (kind) {
        case GrainsKind::voxels:
            return GrainMethod::voxels;
        case GrainsKind::sphere_tracing:
            return GrainMethod::sphere_tracing;
        case GrainsKind::hyperboloid:
            return GrainMethod::hyperboloid;
        default:
            return GrainMethod::cells;
    }
}

constexpr const char* method_names[] = {"voxels", "cells", "sphere-tracing", "hyperboloid"};

GrainMethod choose_method(const OpalAsset& asset, GrainsKind asked, const std::string& file) {
    const std::string obstacle = obstacle_to_cells(asset);
    const bool automatic = asked == GrainsKind::automatic;
    const GrainMethod method = automatic && !obstacle.empty() ? GrainMethod::voxels : method_of(asked);
    if (method != GrainMethod::voxels && !obstacle.empty())
        throw InputError(fmt::format("{}: opal.grains = \"{}\": {}; allowed here: auto, voxels", file,
                                     method_names[static_cast<std::size_t>(method)], obstacle));
    if (method == GrainMethod::voxels && !asset.grain_id)
        throw InputError(
            fmt::format("{}: holds no grain_id{}; build it with [output] grids = [\"grain_id\", \"shape\", \"sites\"]", file,
                        automatic ? ", and cells cannot take its place: " + obstacle : ", which opal.grains = \"voxels\" needs"));
    return method;
}

/// About all that the surface made from a level set encloses.
ConvexBounds bounds_of(const openvdb::FloatGrid& shape) {
    ConvexBounds bounds;
    bounds.hold_inside(shape);
    bounds.widen(2.0 * shape.voxelSize().x());
    return bounds;
}

constexpr std::size_t compared_leaves = 1000;

/// Whether a place is of a grain by its cells, or so nearly that rounding may decide.
bool is_of_grain(const CellField& cells, Vec3 place, std::int32_t grain, float tie_mm) {
    const int cell = locate_cell(cells, place, nearby_cell(cells, place));
    if (cells.grain[cell] == grain) return true;
    const float nearest_mm = delta_mm(cells.sites[cell], place);
    for (std::uint32_t k = cells.first[cell]; k < cells.first[cell + 1]; ++k) {
        const std::int32_t neighbor = cells.neighbors[k];
        if (cells.grain[neighbor] == grain && delta_mm(cells.sites[neighbor], place) <= nearest_mm + tie_mm) return true;
    }
    return false;
}

/// Whether labels are those of the cells that hold the voxels' centres, by a voxel of some leaves each; all but a fiftieth, for
/// what other programs round.
bool agree(const openvdb::Int32Grid& grain_id, const CellField& cells) {
    const std::size_t stride = std::max<std::size_t>(1, grain_id.tree().leafCount() / compared_leaves);
    const float tie_mm = cells.rounding_mm + 1.0e-3f * float(grain_id.voxelSize().x());
    std::size_t index = 0, compared = 0, different = 0;
    for (auto leaf = grain_id.tree().cbeginLeaf(); leaf; ++leaf, ++index) {
        const auto voxel = leaf->cbeginValueOn();
        if (index % stride != 0 || !voxel) continue;
        const openvdb::Vec3d centre_mm = grain_id.indexToWorld(voxel.getCoord());
        const Vec3 place{float(centre_mm.x()), float(centre_mm.y()), float(centre_mm.z())};
        different += is_of_grain(cells, place, *voxel, tie_mm) ? 0 : 1;
        ++compared;
    }
    return 50 * different <= compared;
}

float median(std::vector<float> values) {
    if (values.empty()) return 0.0f;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Grains that labels name but no voxel, or one, shows are not what a picture is made of; all where there are no others.
std::vector<float> larger_than_a_voxel(const std::vector<float>& sizes_mm, float voxel_mm) {
    std::vector<float> larger;
    // A ball as large as one voxel is 1.24 voxels across.
    for (const float size_mm : sizes_mm)
        if (size_mm > 1.3f * voxel_mm) larger.push_back(size_mm);
    return larger.empty() ? sizes_mm : larger;
}

/// Rounding of the walk over the size of a grain above which boundaries are visibly elsewhere.
constexpr float noted_rounding = 0.01f;
/// Voxels across a grain below which much of the light's way lies in the wrong grain.
constexpr float few_voxels = 6.0f;

void note_rounding(const std::string& file, float rounding_mm, float size_mm, std::vector<std::string>& notices) {
    if (rounding_mm > noted_rounding * size_mm)
        notices.push_back(
            fmt::format("{}: the opal lies so far from the origin of its file that rounding moves the boundaries of its "
                        "grains, {:.2g} mm across, by up to {:.1g} mm; model it nearer to the origin",
                        file, size_mm, 2.5f * rounding_mm));
}

void note_coarse_voxels(const std::string& file, float voxel_mm, float size_mm, std::vector<std::string>& notices) {
    if (size_mm < few_voxels * voxel_mm)
        notices.push_back(
            fmt::format("{}: grains are only {:.2g} voxels across, and as coarse as that in the picture; smaller voxels, "
                        "or sites in the file, show them as they are",
                        file, size_mm / voxel_mm));
}

/// Weights nearer to one another than this part of their sites' distance are too alike for the published quadratic.
constexpr float alike = 0.1f;

/// Part of all pairs of neighbours whose weights are so much alike.
double alike_neighbors(const CellField& cells) {
    std::size_t pairs = 0, alike_pairs = 0;
    for (int cell = 0; cell < cells.num_sites; ++cell) {
        const CellSite& site = cells.sites[cell];
        for (std::uint32_t k = cells.first[cell]; k < cells.first[cell + 1]; ++k, ++pairs) {
            const CellSite& neighbor = cells.sites[cells.neighbors[k]];
            const float distance_mm = length(neighbor.position() - site.position());
            if (std::abs(neighbor.weight_mm - site.weight_mm) < alike * distance_mm) ++alike_pairs;
        }
    }
    return double(alike_pairs) / double(std::max<std::size_t>(1, pairs));
}

void note_published_walk(const std::string& file, GrainMethod method, const CellField& cells, std::vector<std::string>& notices) {
    if (method == GrainMethod::sphere_tracing)
        notices.push_back(file + ": opal.grains = \"sphere-tracing\" is there for comparison; cells are as exact and faster");
    if (method == GrainMethod::hyperboloid)
        notices.push_back(
            fmt::format("{}: opal.grains = \"hyperboloid\" is there for comparison: it misses boundaries between sites "
                        "of nearly equal weight, here {:.0f} % of the neighbours; cells do not",
                        file, 100.0 * alike_neighbors(cells)));
}

}  // namespace

GrainSource::GrainSource(const OpalAsset& asset, GrainsKind asked, const std::string& file, std::vector<std::string>& notices)
    : method_(choose_method(asset, asked, file)) {
    if (method_ != GrainMethod::voxels) cells_ = std::make_unique<CellData>(asset.sites, bounds_of(*asset.shape));
    if (asked == GrainsKind::automatic && cells_ && asset.grain_id && !agree(*asset.grain_id, cells_->field())) {
        notices.push_back(file + ": grain_id is not made of the cells of its sites; the grains are taken from its voxels");
        method_ = GrainMethod::voxels;
        cells_.reset();
    }
    if (method_ == GrainMethod::voxels) voxels_ = std::make_unique<GrainGridData>(*asset.grain_id);
    sizes_mm_ = asset.grain_id ? grain_sizes_mm(*asset.grain_id, asset.num_grains())
                               : grain_sizes_mm(cells_->field(), *asset.shape, asset.num_grains());
    if (cells_) {
        note_published_walk(file, method_, cells_->field(), notices);
        note_rounding(file, cells_->field().rounding_mm, median(sizes_mm_), notices);
    } else {
        const float voxel_mm = float(asset.grain_id->voxelSize().x());
        note_coarse_voxels(file, voxel_mm, median(larger_than_a_voxel(sizes_mm_, voxel_mm)), notices);
    }
}

GrainsView GrainSource::view() const {
    GrainsView view;
    view.method = method_;
    if (voxels_) view.voxels = voxels_->field();
    if (cells_) view.cells = cells_->field();
    return view;
}

const char* GrainSource::method_name() const {
    return method_names[static_cast<std::size_t>(method_)];
}

std::size_t GrainSource::size_bytes() const {
    return voxels_ ? voxels_->size_bytes() : cells_->size_bytes();
}

}  // namespace opal
