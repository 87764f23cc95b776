// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal::fuzz {

/// A small opal that scenes name.
struct SeedOpal {
    std::string file;
    bool has_cells = true;   ///< its sites describe its grains
    bool has_voxels = true;  ///< it holds grain_id
    bool has_patches = false;
    std::string recipe;  ///< empty: made by hand
};

const std::vector<SeedOpal>& seed_opals();

/// Files that a case starts from, all in one folder: the opals above; meshes cube.obj (closed), open.obj, cube.ply, cube.stl;
/// tables n.csv, nk.csv, light.csv, absorber.csv, sites.csv, weights.csv, orientations.csv; environments env.exr, env.hdr,
/// env.png; a scene still.toml with its picture still.exr, its parts part_a.exr and part_b.exr, and the state still.checkpoint it
/// was at.
void make_seed_files(const std::filesystem::path& folder);

std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

}  // namespace opal::fuzz
