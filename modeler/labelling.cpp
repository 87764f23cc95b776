// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/labelling.h"

#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "formats/command.h"
#include "modeler/block_tree.h"
#include "modeler/level_set.h"
#include "modeler/site_culling.h"

namespace opal {
namespace {

using LabelLeaf = openvdb::Int32Tree::LeafNodeType;
using ShapeLeaf = openvdb::FloatTree::LeafNodeType;

/// Owners are searched in cubes of this size.
constexpr std::int32_t cell_size = 4;
constexpr std::int32_t cell_voxels = cell_size * cell_size * cell_size;

struct Tile {
    VoxelBlock block;
    std::int32_t label;
};

/// What one thread has found; the order in which threads find things leaves no trace in the tree.
struct Findings {
    std::vector<Tile> tiles;
    std::vector<std::unique_ptr<LabelLeaf>> leaves;
};

class Labeller {
  public:
    Labeller(const SiteCulling& culling, const std::vector<std::int32_t>& label_of_site, const openvdb::FloatTree& shape,
             double voxel_size_mm)
        : culling_(culling), label_of_site_(label_of_site), shape_(shape), voxel_size_mm_(voxel_size_mm) {}

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
        culling_.shrink(from, block.centre_mm(voxel_size_mm_), block.half_diagonal_mm(voxel_size_mm_), kept);
    }

    std::int32_t label_of(std::int32_t site) const { return label_of_site_[static_cast<std::size_t>(site)]; }

    bool share_label(const Candidates& candidates) const {
        const std::int32_t label = label_of(candidates.front());
        return std::all_of(candidates.begin(), candidates.end(), [&](std::int32_t site) { return label_of(site) == label; });
    }

    void add_leaf(const VoxelBlock& block, BlockSide side, const Candidates& candidates) {
        auto leaf = std::make_unique<LabelLeaf>(block.origin, 0, false);
        std::int32_t* const labels = leaf->buffer().data();
        Candidates cell_candidates;
        for (int octant = 0; octant < 8; ++octant) {
            const VoxelBlock cell = block.child(octant);
            cell_candidates.clear();
            shrink(cell, candidates, cell_candidates);
            label_cell(cell, cell_candidates, labels);
        }
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

    /// Writes the labels of a cube of `cell_size` voxels into its leaf's buffer.
    void label_cell(const VoxelBlock& cell, const Candidates& candidates, std::int32_t* leaf_labels) const {
        std::int32_t labels[cell_voxels];
        if (share_label(candidates))
            std::fill(labels, labels + cell_voxels, label_of(candidates.front()));
        else
            search_owners(cell, candidates, labels);
        const std::int32_t* next = labels;
        for (std::int32_t i = 0; i < cell_size; ++i)
            for (std::int32_t j = 0; j < cell_size; ++j, next += cell_size)
                std::copy(next, next + cell_size, leaf_labels + LabelLeaf::coordToOffset(cell.origin.offsetBy(i, j, 0)));
    }

    /// The owner of each voxel. Loops run candidate by candidate over fixed arrays, which compilers turn into vector code; the
    /// formula is weighted_distance_mm's, operation by operation.
    void search_owners(const VoxelBlock& cell, const Candidates& candidates, std::int32_t (&labels)[cell_voxels]) const {
        double smallest_mm[cell_voxels];
        std::fill(std::begin(smallest_mm), std::end(smallest_mm), std::numeric_limits<double>::infinity());
        double owner[cell_voxels] = {};  // candidate number, as a double so that comparison and choice have equal widths
        for (std::size_t n = 0; n < candidates.size(); ++n) {
            const Site& site = culling_.sites()[static_cast<std::size_t>(candidates[n])];
            double squared_mm2[3][cell_size];
            for (int axis = 0; axis < 3; ++axis)
                for (std::int32_t i = 0; i < cell_size; ++i) {
                    const double offset_mm = (cell.origin[axis] + i) * voxel_size_mm_ - site.position_mm[axis];
                    squared_mm2[axis][i] = offset_mm * offset_mm;
                }
            const double weight_mm = static_cast<double>(site.weight_mm);
            const double number = static_cast<double>(n);
            for (std::int32_t row = 0; row < cell_size * cell_size; ++row) {
                const double in_plane_mm2 = squared_mm2[0][row / cell_size] + squared_mm2[1][row % cell_size];
                for (std::int32_t k = 0; k < cell_size; ++k) {
                    const std::int32_t voxel = row * cell_size + k;
                    const double delta_mm = std::sqrt(in_plane_mm2 + squared_mm2[2][k]) - weight_mm;
                    const bool nearer = delta_mm < smallest_mm[voxel];
                    smallest_mm[voxel] = nearer ? delta_mm : smallest_mm[voxel];
                    owner[voxel] = nearer ? number : owner[voxel];
                }
            }
        }
        for (std::int32_t voxel = 0; voxel < cell_voxels; ++voxel)
            labels[voxel] = label_of(candidates[static_cast<std::size_t>(owner[voxel])]);
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

    const SiteCulling& culling_;
    const std::vector<std::int32_t>& label_of_site_;
    const openvdb::FloatTree& shape_;
    double voxel_size_mm_;
    tbb::enumerable_thread_specific<Findings> findings_;
};

}  // namespace

openvdb::Int32Grid::Ptr label_voxels(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                                     const openvdb::FloatGrid& shape_level_set) {
    const double voxel_size_mm = shape_level_set.voxelSize().x();
    Candidates taking_part;
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (label_of_site[i] != 0) taking_part.push_back(static_cast<std::int32_t>(i));

    openvdb::CoordBBox voxels;
    openvdb::Int32Grid::Ptr grid = openvdb::Int32Grid::create(0);
    if (!taking_part.empty() && shape_level_set.tree().evalLeafBoundingBox(voxels)) {
        const VoxelBlock root = covering_block(voxels);
        const openvdb::BBoxd bounds_mm(root.origin.asVec3d() * voxel_size_mm,
                                       root.origin.offsetBy(root.size).asVec3d() * voxel_size_mm);
        const SiteCulling culling(sites, bounds_mm);
        Labeller labeller(culling, label_of_site, shape_level_set.tree(), voxel_size_mm);
        labeller.visit(root, taking_part);
        throw_if_interrupted();
        grid = labeller.finish();
    }
    grid->setTransform(shape_level_set.transform().copy());
    grid->setName(grid_names::grain_id);
    return grid;
}

}  // namespace opal
