// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// Names of the file-level metadata of an opal .vdb (docs/formats.md).
namespace metadata_keys {
inline constexpr const char* schema_version = "opal_schema_version";
inline constexpr const char* program_version = "opal_program_version";
inline constexpr const char* recipe = "opal_recipe";
inline constexpr const char* seed = "opal_seed";
inline constexpr const char* units = "units";
inline constexpr const char* metres_per_unit = "metres_per_unit";
inline constexpr const char* num_sites = "num_sites";
inline constexpr const char* num_grains = "num_grains";
inline constexpr const char* sphere_diameter_nm = "sphere_diameter_nm";
inline constexpr const char* n_sphere = "n_sphere";
inline constexpr const char* n_medium = "n_medium";
inline constexpr const char* coherence_length_um = "coherence_length_um";
inline constexpr const char* absorber = "absorber";
inline constexpr const char* sigma_a_per_mm = "sigma_a_per_mm";
inline constexpr const char* sigma_s_rayleigh = "sigma_s_rayleigh_400nm_per_mm";
inline constexpr const char* sigma_s_mie = "sigma_s_mie_per_mm";
inline constexpr const char* mie_asymmetry = "mie_asymmetry";
inline constexpr const char* n_sphere_spectrum = "n_sphere_spectrum";
inline constexpr const char* n_medium_spectrum = "n_medium_spectrum";
inline constexpr const char* sigma_s_mie_shape = "sigma_s_mie_shape";
inline constexpr const char* mie_phase = "mie_phase";
inline constexpr const char* draine_alpha = "draine_alpha";
inline constexpr const char* mie_particle = "mie_particle";
inline constexpr const char* mie_particle_diameter_nm = "mie_particle_diameter_nm";
inline constexpr const char* bezier_patches = "bezier_patches";
inline constexpr const char* stacking_fault_probability = "stacking_fault_probability";
inline constexpr const char* mosaic_spread_deg = "mosaic_spread_deg";
inline constexpr const char* tessellation = "tessellation";
inline constexpr const char* boundary_noise_amplitude_mm = "boundary_noise_amplitude_mm";
inline constexpr const char* boundary_noise_scale_mm = "boundary_noise_scale_mm";
inline constexpr const char* boundary_noise_octaves = "boundary_noise_octaves";
inline constexpr const char* orientations = "orientations";
}  // namespace metadata_keys

/// A .vdb as it lies on disk, before anything is asked of it.
struct RawOpalFile {
    openvdb::GridPtrVec grids;
    openvdb::MetaMap metadata;

    openvdb::GridBase::Ptr find(const std::string& name) const;
};

/// Reads every grid. Throws InputError for missing, truncated or foreign files.
RawOpalFile read_raw_opal_file(const std::filesystem::path& path);

/// Turns a raw file into a validated asset; `file` names it in messages. See read_opal_asset.
OpalAsset asset_from_raw(const RawOpalFile& raw, const std::string& file, const ReadOpalOptions& options,
                         std::vector<std::string>& notices);

}  // namespace opal
