// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/bezier_patch.h"
#include "formats/random.h"
#include "formats/recipe.h"
#include "formats/spectrum.h"

namespace opal {

/// Raised whenever a reader of the previous version could misread a file. Version 2 brought coefficients that vary, stacking
/// faults and mosaic spread, which a reader of version 1 would leave out without a word; and files of sites alone. Version 3
/// brought indices that vary with the wavelength and scatterers other than Henyey-Greenstein's.
inline constexpr int opal_schema_version = 3;

namespace grid_names {
inline constexpr const char* grain_id = "grain_id";
inline constexpr const char* shape = "shape";
inline constexpr const char* weight = "weight";
inline constexpr const char* sigma_a_scale = "sigma_a_scale";
inline constexpr const char* sigma_s_rayleigh = "sigma_s_rayleigh_400nm";
inline constexpr const char* sigma_s_mie = "sigma_s_mie";
inline constexpr const char* orientation_rgb = "orientation_rgb";
inline constexpr const char* grain_id_float = "grain_id_float";
inline constexpr const char* sites = "sites";
}  // namespace grid_names

/// One site of the tessellation.
struct Site {
    openvdb::Vec3d position_mm;
    float weight_mm = 0.0f;  ///< additive weight w_i, larger starts to grow earlier; multiplicative: the factor, without unit
    std::int32_t grain = 0;  ///< grain it belongs to, from 1; 0 for a hidden site, which owns nothing
};

/// Everything about an opal that does not vary from place to place.
struct OpalConstants {
    double sphere_diameter_nm = 250.0;
    RefractiveIndex n_sphere = 1.45;
    RefractiveIndex n_medium = 1.333;
    double coherence_length_um = 25.0;
    std::string absorber = "carbon";
    SampledSpectrum sigma_a_per_mm;  ///< absorption coefficient over the vacuum wavelength
    double sigma_s_rayleigh_400nm_per_mm = 0.0;
    double sigma_s_mie_per_mm = 0.0;    ///< at 550 nm where sigma_s_mie_shape varies
    SampledSpectrum sigma_s_mie_shape;  ///< over the wavelength, 1 at 550 nm; empty: the same at every wavelength
    MiePhase mie_phase = MiePhase::henyey_greenstein;
    double mie_asymmetry = 0.8;
    double draine_alpha = 1.0;
    MieParticle mie_particle = MieParticle::vacancy;
    double mie_particle_diameter_nm = 0.0;    ///< 0: as large as the crystal's spheres
    double stacking_fault_probability = 0.0;  ///< per layer: 0 fcc, 0.5 random stacking, 1 hcp
    double mosaic_spread_deg = 0.0;           ///< standard deviation of lattice tilt inside a grain
};

/// The opal .vdb in memory: what the two programs hand over. Grids are in millimetres, Z up, voxel centres at integer index
/// coordinates (OpenVDB's convention).
struct OpalAsset {
    openvdb::Int32Grid::Ptr grain_id;  ///< grain of each voxel whose centre is inside the shape, from 1; background 0; null in a
                                       ///< file of sites alone
    openvdb::FloatGrid::Ptr shape;     ///< level set of the outer surface, mm, negative inside; null in a file of sites alone
    openvdb::FloatGrid::Ptr weight;    ///< the weight field, mm, at its own resolution; null unless asked for
    openvdb::FloatGrid::Ptr sigma_a_scale;                       ///< factor on sigma_a_per_mm; null where it does not vary
    openvdb::FloatGrid::Ptr sigma_s_rayleigh_400nm;              ///< mm^-1; null where it does not vary
    openvdb::FloatGrid::Ptr sigma_s_mie;                         ///< mm^-1; null where it does not vary
    std::vector<Site> sites;                                     ///< exact geometry; site id = position in this list + 1
    std::vector<openvdb::math::Quat<float>> grain_orientations;  ///< (x, y, z, w), lattice -> world; element g - 1 is grain g's
    std::vector<BezierPatch> bezier_patches;  ///< the exact surface where the shape has one, outward; else empty
    OpalConstants constants;
    TessellationKind tessellation = TessellationKind::additive;  ///< what the sites' weights mean
    BoundaryNoiseRecipe boundary_noise;                          ///< what displaces the sites' cells; amplitude 0: nothing
    std::string recipe_toml;                                     ///< the resolved recipe; empty for files made elsewhere
    std::uint64_t seed = 0;
    std::string program_version;
    int schema_version = 0;  ///< 0 for files made elsewhere

    std::size_t num_grains() const { return grain_orientations.size(); }
};

/// What goes into a file.
struct WriteOpalOptions {
    /// Of the grids that the asset holds, these; `fields` stands for the coefficients that vary.
    std::vector<OutputGrid> grids = {OutputGrid::grain_id, OutputGrid::shape, OutputGrid::weight, OutputGrid::fields,
                                     OutputGrid::sites};
    bool display_twins = false;  ///< add orientation_rgb and grain_id_float, for clients that cannot show integers
};

/// Writes the asset atomically: grids in the order grain_id, shape, weight, sigma_a_scale, sigma_s_rayleigh_400nm, sigma_s_mie,
/// orientation_rgb, grain_id_float, sites (points last: NanoVDB's converter stops at them), blosc-compressed where available,
/// with schema version, units and full provenance as file metadata. The bytes depend on the asset and the options alone.
/// Throws InputError where the output cannot be created, where twins are asked for without grain_id, or of more grains than a
/// float can tell apart; SystemError where writing fails (full disk).
void write_opal_asset(const OpalAsset& asset, const std::filesystem::path& path, const WriteOpalOptions& options = {});

struct ReadOpalOptions {
    std::uint64_t orientation_seed = 1;  ///< for files that hold no orientations
    bool with_sites = true;
};

/// Reads and validates an opal .vdb. A foreign file with only `grain_id` (int, or float from a client that has no ints) reads
/// too: orientations are then drawn from the stated seed, the shape is made from the labelled voxels, constants are the defaults;
/// each such step appends a line to `notices`. Files of schema 1 lack what version 2 brought, which then is absent. A file of
/// sites alone leaves grain_id and shape null. Throws InputError for missing, truncated or foreign files, neither grain_id nor
/// sites, ids below 0, coefficients that are negative or NaN (naming grid and voxel), broken metadata, schemas newer than ours.
OpalAsset read_opal_asset(const std::filesystem::path& path, const ReadOpalOptions& options, std::vector<std::string>& notices);

/// What `opal-model check` finds: errors make a file unusable, advice does not.
struct AssetCheck {
    std::vector<std::string> errors;
    std::vector<std::string> advice;
};

/// Checks a file against the schema: grids, types, transforms, ids against sites and grains, level set class and sign, fields
/// that cover the shape, twins that agree, a leaf that Blender needs, provenance. Throws InputError only where the file cannot be
/// opened as a .vdb.
AssetCheck check_opal_asset(const std::filesystem::path& path);

/// Makes OpenVDB's grid and attribute types known; called by every function here.
void initialize_openvdb();

/// A uniformly random rotation, a pure function of (seed, stream, index): Shoemake 1992, "Uniform random rotations", Graphics
/// Gems III.
openvdb::math::Quat<float> uniform_rotation(std::uint64_t seed, RandomStream stream, std::uint64_t index);

/// The uniformly random rotation of a grain; `foreign` files have draws of their own.
openvdb::math::Quat<float> random_orientation(std::uint64_t seed, bool foreign, std::uint64_t grain);

/// A repeatable display colour of a grain: hue by the golden angle, constant lightness.
openvdb::Vec3f grain_display_color(std::int32_t grain);

}  // namespace opal
