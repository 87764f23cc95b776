// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/refractive_index.h"

namespace opal {

enum class ShapeKind { ellipsoid, sphere, box, cabochon, mesh, bezier };
enum class BezierPatches { cabochon, teapot };
enum class SiteKind { poisson_disk, jittered_lattice, file };
enum class SiteRegion { shape, bounds };
enum class TessellationKind { additive, voronoi, multiplicative, manhattan };
enum class WeightKind { none, perlin, simplex, linear, radial, distance, grid, csv };
enum class SinteringGraph { apollonius, delaunay, lattice };
enum class BondPreference { none, misorientation, area };
enum class OrientationKind { uniform, fibre, table };
enum class MiePhase { henyey_greenstein, draine, schlick, lorenz_mie };
enum class MieParticle { vacancy, sphere };
enum class FieldKind { constant, noise, layers, grains, grid };
enum class OutputGrid { grain_id, shape, weight, fields, sites };

struct ShapeRecipe {
    ShapeKind kind = ShapeKind::ellipsoid;
    std::array<double, 3> size_mm = {12.0, 9.0, 4.5};  ///< full extents; unused for a mesh and a teapot
    double girdle_mm = 0.0;                            ///< cabochon: thickness of its rounded edge; bezier cabochon: height of
                                                       ///< the widest outline above the lowest point, the dome is the rest
    std::filesystem::path mesh_file;                   ///< mesh: OBJ, PLY, STL or glTF, closed
    double mesh_scale = 1.0;                           ///< mesh: millimetres per unit of the file
    BezierPatches patches = BezierPatches::cabochon;   ///< bezier
    double longest_mm = 20.0;                          ///< bezier teapot: edge of the cube that it is fitted into
    double chord_error_mm = 0.0;                       ///< bezier: of its tessellation; 0: a thousandth of the longest side
};

struct SitesRecipe {
    SiteKind kind = SiteKind::poisson_disk;
    SiteRegion region = SiteRegion::shape;  ///< fill the shape alone or its whole bounding box
    double jitter = 1.0;                    ///< jittered lattice: part of its cell that a site may move in, 0 to 1
    std::filesystem::path file;             ///< file: .csv, .ply or a .vdb with points
    double file_scale = 1.0;                ///< file: millimetres per unit of the file
};

/// One term of the weight field; the terms are added.
struct WeightTerm {
    WeightKind kind = WeightKind::perlin;
    double amplitude = 0.5;                       ///< times the sites' shortest distance; grid, csv: times the values, in mm
    double scale_mm = 3.0;                        ///< noise: length of the coarsest cell
    int octaves = 4;                              ///< noise
    std::array<double, 3> direction = {0, 0, 1};  ///< linear: the way in which the weight grows
    std::array<double, 3> center_mm = {0, 0, 0};  ///< radial
    std::filesystem::path file;                   ///< grid: .vdb; csv: one value per site, in the sites' order
    std::string grid;                             ///< grid: name of a float grid in the file; empty: its only one
};

/// A smooth displacement of space under the grains, which makes their boundaries irregular.
struct BoundaryNoiseRecipe {
    double amplitude_mm = 0.0;  ///< largest displacement along each axis; 0: none
    double scale_mm = 0.3;
    int octaves = 2;
};

struct SinteringRecipe {
    SinteringGraph graph = SinteringGraph::apollonius;
    double probability = 0.05;  ///< of each bond; used where neither of the next two is given
    std::int64_t target_grains = 0;
    double mean_grain_mm = 0.0;  ///< diameter of a ball of the mean grain's volume
    BondPreference preference = BondPreference::none;
    double misorientation_deg = 15.0;  ///< preference misorientation: bonds across much larger angles are rarely kept
};

struct OrientationRecipe {
    OrientationKind kind = OrientationKind::uniform;
    std::array<double, 3> axis = {0, 0, 1};     ///< fibre: direction in the opal
    std::array<double, 3> lattice = {1, 1, 1};  ///< fibre: lattice direction that lies along the axis
    double spread_deg = 10.0;                   ///< fibre: angular standard deviation of the tilt away from it
    std::filesystem::path file;                 ///< table: .csv with grain,x,y,z,w
};

struct GrainsRecipe {
    std::int64_t num_sites = 900;
    SitesRecipe sites;
    double voxel_size_mm = 0.0;  ///< edge of a voxel; `resolution` is already turned into it
    std::uint64_t seed = 1;
    TessellationKind tessellation = TessellationKind::additive;
    std::vector<WeightTerm> weight = {WeightTerm{}};
    bool limit_weights = true;  ///< scale the weights down until neighbouring sites differ by less than their shortest distance
    BoundaryNoiseRecipe boundary_noise;
    SinteringRecipe sintering;
    OrientationRecipe orientation;
};

struct CrystalRecipe {
    double sphere_diameter_nm = 250.0;
    RefractiveIndex n_sphere = 1.45;
    RefractiveIndex n_medium = 1.333;
    double coherence_length_um = 25.0;
    double stacking_fault_probability = 0.0;  ///< per layer: 0 fcc, 0.5 random stacking, 1 hcp
    double mosaic_spread_deg = 0.0;           ///< standard deviation of lattice tilt inside a grain
};

/// How a coefficient varies from place to place: a factor around 1 on its constant value.
struct FieldRecipe {
    FieldKind kind = FieldKind::constant;
    double contrast = 0.5;                        ///< noise, layers, grains: the factor lies in [1 - contrast, 1 + contrast]
    double scale_mm = 2.0;                        ///< noise: coarsest cell; layers: period
    int octaves = 3;                              ///< noise
    std::array<double, 3> direction = {0, 0, 1};  ///< layers: their normal
    std::filesystem::path file;                   ///< grid: .vdb
    std::string grid;                             ///< grid: name of a float grid in the file; empty: its only one
    double voxel_size_mm = 0.0;                   ///< 0: as coarse as the field allows
};

struct BaseColorRecipe {
    std::string absorber = "carbon";  ///< a built-in name, or a .csv's path
    double sigma_a_per_mm = 0.25;     ///< at the reference wavelength; the spectrum is scaled to it
    double sigma_a_reference_nm = 550.0;
    double sigma_s_rayleigh_400nm_per_mm = 0.0;
    double sigma_s_mie_per_mm = 0.0;
    MiePhase mie_phase = MiePhase::henyey_greenstein;
    double mie_asymmetry = 0.8;                       ///< mean cosine of those in closed form, whatever their parameter
    double draine_alpha = 1.0;                        ///< Draine's second parameter
    MieParticle mie_particle = MieParticle::vacancy;  ///< what scatters: a missing sphere or a sphere too many
    double mie_particle_diameter_nm = 0.0;            ///< 0: as large as the crystal's spheres
    double defect_concentration = 0.0;                ///< such particles per lattice site; above 0, sigma_s_mie follows from it
    FieldRecipe sigma_a_field;
    FieldRecipe sigma_s_rayleigh_field;
    FieldRecipe sigma_s_mie_field;
};

struct OutputRecipe {
    /// Which grids the file holds; `fields` stands for the coefficients that vary.
    std::vector<OutputGrid> grids = {OutputGrid::grain_id, OutputGrid::shape, OutputGrid::fields, OutputGrid::sites};
    bool for_blender = false;  ///< add display twins of the grids that Blender cannot show

    bool has(OutputGrid grid) const;
};

/// What opal-model builds: a validated recipe.toml.
struct Recipe {
    ShapeRecipe shape;
    GrainsRecipe grains;
    CrystalRecipe crystal;
    BaseColorRecipe base_color;
    OutputRecipe output;
    int resolution = 0;  ///< voxels along the longest side where the recipe asks for that; else 0
};

/// Reads and validates. Throws InputError located at file:line:column.
Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides);
/// The same from text; `name` stands for the file in messages.
Recipe parse_recipe(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);

/// The recipe with every default spelled out, as TOML that `parse_recipe` reads back to the same recipe. Files are named without
/// their folders, so that the same input gives the same text wherever it lies.
std::string recipe_to_toml(const Recipe& recipe);

}  // namespace opal
