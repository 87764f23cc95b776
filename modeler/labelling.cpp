// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/labelling.h"

#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "formats/command.h"
#include "modeler/block_tree.h"
#include "modeler/boundary_noise.h"
#include "modeler/level_set.h"
#include "modeler/owner_search.h"
#include "modeler/site_culling.h"

namespace opal {
namespace {

using LabelLeaf = openvdb::Int32Tree::LeafNodeType;
using ShapeLeaf = openvdb::FloatTree::LeafNodeType;

struct Tile {
    VoxelBlock block;
    std::int32_t label;
};

/// What one thread has found; the order in which threads find things leaves no trace in the tree.
struct Findings {
    std::vector<Tile> tiles;
    std::vector<std::unique_ptr<LabelLeaf>> leaves;
};

template <typename Metric>
class Labeller {
  public:
    /// `noise` may be null.
    Labeller(const SiteCulling<Metric>& culling, const std::vector<std::int32_t>& label_of_site, const openvdb::FloatTree& shape,
             double voxel_size_mm, const BoundaryNoise* noise)
        : culling_(culling), label_of_site_(label_of_site), shape_(shape), voxel_size_mm_(voxel_size_mm), noise_(noise) {}

    void visit(const VoxelBlock& block, const Candidates& parent_candidates) {
        const BlockSide side = block_side(shape_, block.origin, block.size);
        if (side == BlockSide::outside || interrupt_requested()) return;
        Candidates candidates;
        shrink(block, parent_candidates, candidates);
        if (side == BlockSide::inside && share_label(candidates) && block.size <= node_size)
            findings_.local().tiles.push_back({block, label_of(candidates.front())});
        else if (block.size == leaf_size)
            add_leaf(block, side, candidates);
        else
            for_each_child(block, [&](const VoxelBlock& child) { visit(child, candidates); });
    }

    openvdb::Int32Grid::Ptr finish() {
        const auto grid = openvdb::Int32Grid::create(0);
        openvdb::Int32Tree& tree = grid->tree();
        for (Findings& findings : findings_) {
            for (const Tile& tile : findings.tiles) add_tile(tree, tile);
            for (auto& leaf : findings.leaves) tree.addLeaf(leaf.release());
        }
        openvdb::tools::prune(tree);
        if (tree.leafCount() == 0 && !tree.empty()) tree.touchLeaf(tree.cbeginValueOn().getCoord());
        return grid;
    }

  private:
    void shrink(const VoxelBlock& block, std::span<const std::int32_t> from, Candidates& kept) const {
        const Ball ball{block.centre_mm(voxel_size_mm_), block.half_diagonal_mm(voxel_size_mm_)};
        shrink(noise_ ? noise_->displaced(ball) : ball, from, kept);
    }

    void shrink(const Ball& ball, std::span<const std::int32_t> from, Candidates& kept) const {
        culling_.shrink(from, ball.centre_mm, ball.radius_mm, kept);
    }

    std::int32_t label_of(std::int32_t site) const { return label_of_site_[static_cast<std::size_t>(site)]; }

    bool share_label(const Candidates& candidates) const {
        const std::int32_t label = label_of(candidates.front());
        return std::all_of(candidates.begin(), candidates.end(), [&](std::int32_t site) { return label_of(site) == label; });
    }

    void add_leaf(const VoxelBlock& block, BlockSide side, const Candidates& candidates) {
        auto leaf = std::make_unique<LabelLeaf>(block.origin, 0, false);
        std::int32_t* const labels = leaf->buffer().data();
        if (noise_)
            label_displaced(block, candidates, labels);
        else
            label_straight(block, candidates, labels);
        if (side == BlockSide::inside) {
            const std::int32_t first = labels[0];
            if (std::all_of(labels, labels + LabelLeaf::SIZE, [first](std::int32_t label) { return label == first; })) {
                findings_.local().tiles.push_back({block, first});
                return;
            }
            leaf->setValuesOn();
        } else {
            keep_inside(*leaf, *shape_.probeConstLeaf(block.origin));
            if (leaf->isEmpty()) return;
        }
        findings_.local().leaves.push_back(std::move(leaf));
    }

    static void keep_inside(LabelLeaf& leaf, const ShapeLeaf& shape) {
        for (openvdb::Index n = 0; n < LabelLeaf::SIZE; ++n) {
            if (shape.getValue(n) < 0.0f)
                leaf.setValueOn(n);
            else
                leaf.setValueOff(n, 0);
        }
    }

    void label_straight(const VoxelBlock& leaf, const Candidates& candidates, std::int32_t* leaf_labels) const {
        Candidates kept;
        for (int octant = 0; octant < 8; ++octant) {
            const VoxelBlock cell = leaf.child(octant);
            kept.clear();
            shrink(cell, candidates, kept);
            label_cell(cell, kept, leaf_labels, [&](auto& search, const Site& site, std::int32_t number) {
                search.offer(site, number, cell, voxel_size_mm_);
            });
        }
    }

    /// The displaced centres are known here, so the balls around them are as small as can be.
    void label_displaced(const VoxelBlock& leaf, const Candidates& candidates, std::int32_t* leaf_labels) const {
        std::vector<openvdb::Vec3d> places_mm;
        for (int octant = 0; octant < 8; ++octant)
            for (const openvdb::Coord& voxel : leaf.child(octant).box()) places_mm.push_back(voxel.asVec3d() * voxel_size_mm_);
        noise_->displace(places_mm);

        Candidates kept;
        for (int octant = 0; octant < 8; ++octant) {
            const std::span<const openvdb::Vec3d> of_cell(&places_mm[static_cast<std::size_t>(octant * cell_voxels)],
                                                          cell_voxels);
            kept.clear();
            shrink(ball_around(of_cell), candidates, kept);
            const CellPoints points(of_cell);
            label_cell(leaf.child(octant), kept, leaf_labels,
                       [&](auto& search, const Site& site, std::int32_t number) { search.offer(site, number, points); });
        }
    }

    static Ball ball_around(std::span<const openvdb::Vec3d> points_mm) {
        openvdb::BBoxd box;
        for (const openvdb::Vec3d& point_mm : points_mm) box.expand(point_mm);
        Ball ball{box.getCenter(), 0.0};
        for (const openvdb::Vec3d& point_mm : points_mm)
            ball.radius_mm = std::max(ball.radius_mm, (point_mm - ball.centre_mm).length());
        return ball;
    }

    /// Writes the labels of a cell's voxels into its leaf's buffer. `offer` shows a site to the search.
    template <typename Offer>
    void label_cell(const VoxelBlock& cell, const Candidates& candidates, std::int32_t* leaf_labels, const Offer& offer) const {
        std::int32_t labels[cell_voxels];
        if (share_label(candidates)) {
            std::fill(labels, labels + cell_voxels, label_of(candidates.front()));
        } else {
            OwnerSearch<Metric> search;
            for (std::size_t n = 0; n < candidates.size(); ++n)
                offer(search, culling_.sites()[static_cast<std::size_t>(candidates[n])], static_cast<std::int32_t>(n));
            for (std::int32_t voxel = 0; voxel < cell_voxels; ++voxel) labels[voxel] = label_of(candidates[search.owner(voxel)]);
        }
        const std::int32_t* next = labels;
        for (std::int32_t i = 0; i < cell_size; ++i)
            for (std::int32_t j = 0; j < cell_size; ++j, next += cell_size)
                std::copy(next, next + cell_size, leaf_labels + LabelLeaf::coordToOffset(cell.origin.offsetBy(i, j, 0)));
    }

    static void add_tile(openvdb::Int32Tree& tree, const Tile& tile) {
        if (tile.block.size == node_size) {
            tree.addTile(2, tile.block.origin, tile.label, true);
            return;
        }
        for (std::int32_t i = 0; i < tile.block.size; i += leaf_size)
            for (std::int32_t j = 0; j < tile.block.size; j += leaf_size)
                for (std::int32_t k = 0; k < tile.block.size; k += leaf_size)
                    tree.addTile(1, tile.block.origin.offsetBy(i, j, k), tile.label, true);
    }

    const SiteCulling<Metric>& culling_;
    const std::vector<std::int32_t>& label_of_site_;
    const openvdb::FloatTree& shape_;
    double voxel_size_mm_;
    const BoundaryNoise* noise_;
    tbb::enumerable_thread_specific<Findings> findings_;
};

}  // namespace

openvdb::Int32Grid::Ptr label_voxels(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                                     const openvdb::FloatGrid& shape_level_set, const Tessellation& tessellation) {
    const double voxel_size_mm = shape_level_set.voxelSize().x();
    Candidates taking_part;
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (label_of_site[i] != 0) taking_part.push_back(static_cast<std::int32_t>(i));

    openvdb::CoordBBox voxels;
    openvdb::Int32Grid::Ptr grid = openvdb::Int32Grid::create(0);
    if (!taking_part.empty() && shape_level_set.tree().evalLeafBoundingBox(voxels)) {
        const VoxelBlock root = covering_block(voxels);
        openvdb::BBoxd bounds_mm(root.origin.asVec3d() * voxel_size_mm,
                                 root.origin.offsetBy(root.size).asVec3d() * voxel_size_mm);
        std::optional<BoundaryNoise> noise;
        if (tessellation.boundary_noise.amplitude_mm > 0.0) {
            noise.emplace(tessellation.boundary_noise, tessellation.seed, bounds_mm);
            bounds_mm.expand(tessellation.boundary_noise.amplitude_mm);
        }
        with_metric(tessellation.kind, [&](auto metric) {
            const SiteCulling<decltype(metric)> culling(sites, bounds_mm);
            Labeller<decltype(metric)> labeller(culling, label_of_site, shape_level_set.tree(), voxel_size_mm,
                                                noise ? &*noise : nullptr);
            labeller.visit(root, taking_part);
            throw_if_interrupted();
            grid = labeller.finish();
        });
    }
    grid->setTransform(shape_level_set.transform().copy());
    grid->setName(grid_names::grain_id);
    return grid;
}

}  // namespace opal
