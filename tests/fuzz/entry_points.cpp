// SPDX-License-Identifier: GPL-3.0-or-later
#include "entry_points.h"

#include <unistd.h>

#include <cmath>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_metadata.h"
#include "formats/recipe.h"
#include "formats/scene.h"
#include "renderer/host/checkpoint.h"

namespace opal::fuzz {
namespace {

/// The metadata of a small opal whose orientations are listed.
openvdb::MetaMap sound_metadata() {
    initialize_openvdb();
    OpalAsset asset;
    asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.25);
    asset.grain_orientations = {random_orientation(1, true, 1), random_orientation(1, true, 2)};
    return opal_metadata(asset, false);
}

/// Puts a value in the place of an entry, of the type that the entry has where the value can be read as such.
void replace_entry(openvdb::MetaMap& metadata, const std::string& name, const std::string& value) {
    const openvdb::Metadata::Ptr old = metadata[name];
    const std::string type = old ? old->typeName() : "string";
    metadata.removeMeta(name);
    std::istringstream stream(value);
    double number = 0.0;
    const bool is_number = bool(stream >> number) && number > -2.0e9 && number < 2.0e9;
    if (type == "double" && is_number)
        metadata.insertMeta(name, openvdb::DoubleMetadata(number));
    else if (type == "int64" && is_number)
        metadata.insertMeta(name, openvdb::Int64Metadata(std::int64_t(number)));
    else if (type == "int32" && is_number)
        metadata.insertMeta(name, openvdb::Int32Metadata(std::int32_t(number)));
    else
        metadata.insertMeta(name, openvdb::StringMetadata(value));
}

}  // namespace

bool check_scene_text(const std::string& text) {
    try {
        const std::string written = scene_to_toml(parse_scene(text, "case.toml", {}));
        if (scene_to_toml(parse_scene(written, "case.toml", {})) != written)
            throw std::logic_error("the scene is another when it is read again");
    } catch (const InputError&) {
        return false;
    }
    return true;
}

bool check_recipe_text(const std::string& text) {
    try {
        const std::string written = recipe_to_toml(parse_recipe(text, "case.toml", {}));
        if (recipe_to_toml(parse_recipe(written, "case.toml", {})) != written)
            throw std::logic_error("the recipe is another when it is read again");
    } catch (const InputError&) {
        return false;
    }
    return true;
}

bool check_checkpoint_bytes(const std::string& bytes) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / ("opal_fuzz." + std::to_string(::getpid()));
    std::ofstream(file, std::ios::binary) << bytes;
    bool sound = true;
    try {
        read_checkpoint_header(file);
        Film film(12, 9, false);
        read_checkpoint(file, film);
        for (const float value : film.to_image().pixels)
            if (!std::isfinite(value)) throw std::logic_error("the checkpoint's picture is no number");
    } catch (const InputError&) {
        sound = false;
    }
    std::filesystem::remove(file);
    return sound;
}

bool check_opal_metadata_text(const std::string& text) {
    openvdb::MetaMap metadata = sound_metadata();
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (const std::size_t equals = line.find(" = "); equals != std::string::npos && equals > 0)
            replace_entry(metadata, line.substr(0, equals), line.substr(equals + 3));
    OpalAsset asset;
    try {
        read_opal_metadata(metadata, "case.vdb", asset);
    } catch (const InputError&) {
        return false;
    }
    return true;
}

}  // namespace opal::fuzz
