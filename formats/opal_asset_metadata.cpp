// SPDX-License-Identifier: Apache-2.0
#include "formats/opal_asset_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "formats/bezier_patch_text.h"
#include "formats/error.h"
#include "formats/opal_asset_io.h"
#include "formats/recipe_names.h"
#include "formats/text.h"
#include "formats/units.h"
#include "formats_generated/version.h"

namespace opal {
namespace {

using Quat = openvdb::math::Quat<float>;

constexpr const char* orientations_from_seed = "seed";
constexpr const char* orientations_with_sites = "sites";

bool follow_from_seed(const OpalAsset& asset) {
    for (std::size_t i = 0; i < asset.num_grains(); ++i) {
        const Quat drawn = random_orientation(asset.seed, false, i + 1);
        for (int c = 0; c < 4; ++c)
            if (asset.grain_orientations[i][c] != drawn[c]) return false;
    }
    return true;
}

/// "x y z w" for each grain in turn, in the shortest form that reads back to the same floats.
std::string orientations_to_text(const std::vector<Quat>& orientations) {
    std::string text;
    for (const Quat& q : orientations) text += fmt::format("{}{} {} {} {}", text.empty() ? "" : "\n", q[0], q[1], q[2], q[3]);
    return text;
}

/// Metadata of one key, checked for type and range; errors name the file and the key.
class MetadataReader {
  public:
    MetadataReader(const openvdb::MetaMap& metadata, std::string file) : metadata_(metadata), file_(std::move(file)) {}

    bool has(const char* key) const { return bool(metadata_[key]); }
    double number(const char* key, double min, double max) const {
        const double value = typed<openvdb::DoubleMetadata>(key)->value();
        if (!(value >= min && value <= max))
            throw InputError(
                fmt::format("{}: metadata '{}': {} is out of range; allowed: {} to {}", file_, key, value, min, max));
        return value;
    }
    std::int64_t integer64(const char* key) const { return typed<openvdb::Int64Metadata>(key)->value(); }
    int integer32(const char* key) const { return typed<openvdb::Int32Metadata>(key)->value(); }
    std::string text(const char* key) const { return typed<openvdb::StringMetadata>(key)->value(); }

  private:
    template <typename Type>
    typename Type::ConstPtr typed(const char* key) const {
        const openvdb::Metadata::ConstPtr found = metadata_[key];
        if (!found) throw InputError(fmt::format("{}: metadata '{}' is missing", file_, key));
        const auto value = openvdb::DynamicPtrCast<const Type>(found);
        if (!value) throw InputError(fmt::format("{}: metadata '{}' has type {}", file_, key, found->typeName()));
        return value;
    }

    const openvdb::MetaMap& metadata_;
    std::string file_;
};

/// An index: its value at the sodium line, and how it varies where it does.
RefractiveIndex read_index(const MetadataReader& reader, const std::string& file, const char* key, const char* spectrum_key) {
    const double constant = reader.number(key, 1.0, 4.0);
    if (!reader.has(spectrum_key)) return constant;
    try {
        return RefractiveIndex::from_text(reader.text(spectrum_key));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: metadata '{}': {}", file, spectrum_key, error.what()));
    }
}

template <typename Enum>
Enum read_choice(const MetadataReader& reader, const std::string& file, const char* key, const recipe_names::Names& known) {
    const std::string name = reader.text(key);
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw InputError(fmt::format("{}: metadata '{}': '{}' is not known; allowed: {}", file, key, name, join(known)));
    return recipe_names::value<Enum>(known, name);
}

void read_scatterers(const MetadataReader& reader, const std::string& file, OpalConstants& constants) {
    constants.mie_phase = read_choice<MiePhase>(reader, file, metadata_keys::mie_phase, recipe_names::mie_phases);
    constants.draine_alpha = reader.number(metadata_keys::draine_alpha, 0.0, 1.0e3);
    constants.mie_particle = read_choice<MieParticle>(reader, file, metadata_keys::mie_particle, recipe_names::mie_particles);
    constants.mie_particle_diameter_nm = reader.number(metadata_keys::mie_particle_diameter_nm, 0.0, 1.0e4);
    if (constants.mie_particle_diameter_nm > 0.0 && constants.mie_particle_diameter_nm < 1.0)
        throw InputError(fmt::format("{}: metadata '{}': {} is out of range; allowed: 0 or 1 to 10000", file,
                                     metadata_keys::mie_particle_diameter_nm, constants.mie_particle_diameter_nm));
    if (!reader.has(metadata_keys::sigma_s_mie_shape)) return;
    try {
        constants.sigma_s_mie_shape = spectrum_from_text(reader.text(metadata_keys::sigma_s_mie_shape));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: metadata '{}': {}", file, metadata_keys::sigma_s_mie_shape, error.what()));
    }
}

OpalConstants read_constants(const MetadataReader& reader, const std::string& file, int version) {
    OpalConstants constants;
    constants.sphere_diameter_nm = reader.number(metadata_keys::sphere_diameter_nm, 50.0, 1000.0);
    constants.n_sphere = read_index(reader, file, metadata_keys::n_sphere, metadata_keys::n_sphere_spectrum);
    constants.n_medium = read_index(reader, file, metadata_keys::n_medium, metadata_keys::n_medium_spectrum);
    constants.coherence_length_um = reader.number(metadata_keys::coherence_length_um, 0.5, 1.0e4);
    constants.absorber = reader.text(metadata_keys::absorber);
    try {
        constants.sigma_a_per_mm = spectrum_from_text(reader.text(metadata_keys::sigma_a_per_mm));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: metadata '{}': {}", file, metadata_keys::sigma_a_per_mm, error.what()));
    }
    constants.sigma_s_rayleigh_400nm_per_mm = reader.number(metadata_keys::sigma_s_rayleigh, 0.0, 1.0e9);
    constants.sigma_s_mie_per_mm = reader.number(metadata_keys::sigma_s_mie, 0.0, 1.0e9);
    constants.mie_asymmetry = reader.number(metadata_keys::mie_asymmetry, -0.9999, 0.9999);
    if (version >= 2) {
        constants.stacking_fault_probability = reader.number(metadata_keys::stacking_fault_probability, 0.0, 1.0);
        constants.mosaic_spread_deg = reader.number(metadata_keys::mosaic_spread_deg, 0.0, 180.0);
    }
    if (version >= 3) read_scatterers(reader, file, constants);
    return constants;
}

void read_bezier_patches(const MetadataReader& reader, const std::string& file, OpalAsset& asset) {
    if (!reader.has(metadata_keys::bezier_patches)) return;
    try {
        asset.bezier_patches = bezier_patches_from_text(reader.text(metadata_keys::bezier_patches));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: metadata '{}': {}", file, metadata_keys::bezier_patches, error.what()));
    }
}

void read_tessellation(const MetadataReader& reader, const std::string& file, OpalAsset& asset) {
    asset.tessellation = read_choice<TessellationKind>(reader, file, metadata_keys::tessellation, recipe_names::tessellations);
    asset.boundary_noise.amplitude_mm = reader.number(metadata_keys::boundary_noise_amplitude_mm, 0.0, 1.0e7);
    asset.boundary_noise.scale_mm = reader.number(metadata_keys::boundary_noise_scale_mm, 1.0e-6, 1.0e7);
    asset.boundary_noise.octaves = reader.integer32(metadata_keys::boundary_noise_octaves);
    if (asset.boundary_noise.octaves < 1 || asset.boundary_noise.octaves > 16)
        throw InputError(fmt::format("{}: metadata '{}': {} is out of range; allowed: 1 to 16", file,
                                     metadata_keys::boundary_noise_octaves, asset.boundary_noise.octaves));
}

void read_orientations(const MetadataReader& reader, const std::string& file, StatedGrains& grains) {
    const std::string text = reader.text(metadata_keys::orientations);
    grains.from_seed = text == orientations_from_seed;
    if (grains.from_seed || text == orientations_with_sites) return;
    std::istringstream stream(text);
    Quat q;
    while (stream >> q[0] >> q[1] >> q[2] >> q[3]) grains.orientations.push_back(q);
    const bool unit = std::all_of(grains.orientations.begin(), grains.orientations.end(), [](const Quat& orientation) {
        return std::abs(orientation.dot(orientation) - 1.0f) < 2.0e-3f;
    });
    if (!stream.eof() || !unit || grains.orientations.size() != grains.num_grains)
        throw InputError(fmt::format("{}: metadata '{}': is not '{}', '{}' or one unit quaternion for each of {} grains", file,
                                     metadata_keys::orientations, orientations_from_seed, orientations_with_sites,
                                     grains.num_grains));
}

}  // namespace

openvdb::MetaMap opal_metadata(const OpalAsset& asset, bool with_sites) {
    const OpalConstants& constants = asset.constants;
    openvdb::MetaMap metadata;
    const auto text = [&](const char* key, const std::string& value) {
        metadata.insertMeta(key, openvdb::StringMetadata(value));
    };
    const auto number = [&](const char* key, double value) { metadata.insertMeta(key, openvdb::DoubleMetadata(value)); };
    metadata.insertMeta(metadata_keys::schema_version, openvdb::Int32Metadata(opal_schema_version));
    text(metadata_keys::program_version, OPAL_VERSION_STRING);
    text(metadata_keys::recipe, asset.recipe_toml);
    metadata.insertMeta(metadata_keys::seed, openvdb::Int64Metadata(static_cast<std::int64_t>(asset.seed)));
    text(metadata_keys::units, "mm");
    number(metadata_keys::metres_per_unit, units::metres_per_world_unit);
    metadata.insertMeta(metadata_keys::num_sites, openvdb::Int64Metadata(static_cast<std::int64_t>(asset.sites.size())));
    metadata.insertMeta(metadata_keys::num_grains, openvdb::Int64Metadata(static_cast<std::int64_t>(asset.num_grains())));
    number(metadata_keys::sphere_diameter_nm, constants.sphere_diameter_nm);
    number(metadata_keys::n_sphere, constants.n_sphere.at(sodium_d_nm));
    number(metadata_keys::n_medium, constants.n_medium.at(sodium_d_nm));
    if (constants.n_sphere.varies()) text(metadata_keys::n_sphere_spectrum, constants.n_sphere.to_text());
    if (constants.n_medium.varies()) text(metadata_keys::n_medium_spectrum, constants.n_medium.to_text());
    number(metadata_keys::coherence_length_um, constants.coherence_length_um);
    text(metadata_keys::absorber, constants.absorber);
    text(metadata_keys::sigma_a_per_mm, spectrum_to_text(constants.sigma_a_per_mm));
    number(metadata_keys::sigma_s_rayleigh, constants.sigma_s_rayleigh_400nm_per_mm);
    number(metadata_keys::sigma_s_mie, constants.sigma_s_mie_per_mm);
    if (!constants.sigma_s_mie_shape.value.empty())
        text(metadata_keys::sigma_s_mie_shape, spectrum_to_text(constants.sigma_s_mie_shape));
    text(metadata_keys::mie_phase, recipe_names::name(recipe_names::mie_phases, constants.mie_phase));
    number(metadata_keys::mie_asymmetry, constants.mie_asymmetry);
    number(metadata_keys::draine_alpha, constants.draine_alpha);
    text(metadata_keys::mie_particle, recipe_names::name(recipe_names::mie_particles, constants.mie_particle));
    number(metadata_keys::mie_particle_diameter_nm, constants.mie_particle_diameter_nm);
    number(metadata_keys::stacking_fault_probability, constants.stacking_fault_probability);
    number(metadata_keys::mosaic_spread_deg, constants.mosaic_spread_deg);
    text(metadata_keys::tessellation, recipe_names::name(recipe_names::tessellations, asset.tessellation));
    number(metadata_keys::boundary_noise_amplitude_mm, asset.boundary_noise.amplitude_mm);
    number(metadata_keys::boundary_noise_scale_mm, asset.boundary_noise.scale_mm);
    metadata.insertMeta(metadata_keys::boundary_noise_octaves, openvdb::Int32Metadata(asset.boundary_noise.octaves));
    if (!asset.bezier_patches.empty()) text(metadata_keys::bezier_patches, bezier_patches_to_text(asset.bezier_patches));
    const bool from_seed = follow_from_seed(asset);
    text(metadata_keys::orientations, from_seed    ? orientations_from_seed
                                      : with_sites ? orientations_with_sites
                                                   : orientations_to_text(asset.grain_orientations));
    return metadata;
}

bool has_opal_metadata(const openvdb::MetaMap& metadata) {
    return bool(metadata[metadata_keys::schema_version]);
}

StatedGrains read_opal_metadata(const openvdb::MetaMap& metadata, const std::string& file, OpalAsset& asset) {
    const MetadataReader reader(metadata, file);
    asset.schema_version = reader.integer32(metadata_keys::schema_version);
    if (asset.schema_version < 1 || asset.schema_version > opal_schema_version)
        throw InputError(fmt::format("{}: opal schema {} is not known; this program reads 1 to {}", file, asset.schema_version,
                                     opal_schema_version));
    asset.constants = read_constants(reader, file, asset.schema_version);
    asset.recipe_toml = reader.text(metadata_keys::recipe);
    asset.program_version = reader.text(metadata_keys::program_version);
    asset.seed = static_cast<std::uint64_t>(reader.integer64(metadata_keys::seed));
    const std::int64_t stated = reader.integer64(metadata_keys::num_grains);
    if (stated < 0 || stated > INT32_MAX)
        throw InputError(fmt::format("{}: metadata '{}': {} is out of range", file, metadata_keys::num_grains, stated));
    StatedGrains grains;
    grains.num_grains = std::size_t(stated);
    if (asset.schema_version >= 2) {
        read_tessellation(reader, file, asset);
        read_bezier_patches(reader, file, asset);
        read_orientations(reader, file, grains);
    }
    return grains;
}

}  // namespace opal
