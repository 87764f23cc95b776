// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace opal {

enum class ShapeKind { ellipsoid, sphere, box, cabochon, mesh };
enum class TessellationKind { additive, voronoi };
enum class WeightKind { none, perlin };
enum class SinteringGraph { apollonius, delaunay };

struct ShapeRecipe {
    ShapeKind kind = ShapeKind::ellipsoid;
    std::array<double, 3> size_mm = {12.0, 9.0, 4.5};  ///< full extents; unused for a mesh
    double girdle_mm = 0.0;                            ///< cabochon: thickness of its rounded edge
    std::filesystem::path mesh_file;                   ///< mesh: OBJ, PLY, STL or glTF, closed
    double mesh_scale = 1.0;                           ///< mesh: millimetres per unit of the file
};

struct WeightRecipe {
    WeightKind kind = WeightKind::perlin;
    double amplitude = 0.5;  ///< times the sites' shortest distance: up to 0.5 keeps the condition |w_i - w_j| < r
    double scale_mm = 3.0;   ///< length of the coarsest noise cell
    int octaves = 4;
};

struct SinteringRecipe {
    SinteringGraph graph = SinteringGraph::apollonius;
    double probability = 0.05;  ///< of each bond; used where target_grains is 0
    std::int64_t target_grains = 0;
};

struct GrainsRecipe {
    std::int64_t num_sites = 900;
    double voxel_size_mm = 0.0;  ///< edge of a voxel; `resolution` is already turned into it
    std::uint64_t seed = 1;
    TessellationKind tessellation = TessellationKind::additive;
    WeightRecipe weight;
    SinteringRecipe sintering;
};

struct CrystalRecipe {
    double sphere_diameter_nm = 250.0;
    double n_sphere = 1.45;
    double n_medium = 1.333;
    double coherence_length_um = 25.0;
};

struct BaseColorRecipe {
    std::string absorber = "carbon";  ///< a built-in name, or a .csv's path
    double sigma_a_per_mm = 0.25;     ///< at 550 nm
    double sigma_s_rayleigh_400nm_per_mm = 0.0;
    double sigma_s_mie_per_mm = 0.0;
    double mie_asymmetry = 0.8;  ///< Henyey-Greenstein g of the Mie-like part
};

/// What opal-model builds: a validated recipe.toml.
struct Recipe {
    ShapeRecipe shape;
    GrainsRecipe grains;
    CrystalRecipe crystal;
    BaseColorRecipe base_color;
    int resolution = 0;  ///< voxels along the longest side where the recipe asks for that; else 0
};

/// Reads and validates. Throws InputError located at file:line:column.
Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides);
/// The same from text; `name` stands for the file in messages.
Recipe parse_recipe(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);

/// The recipe with every default spelled out, as TOML that `parse_recipe` reads back to the same recipe.
std::string recipe_to_toml(const Recipe& recipe);

}  // namespace opal
