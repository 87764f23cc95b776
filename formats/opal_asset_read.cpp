// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/TopologyToLevelSet.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>

#include "formats/error.h"
#include "formats/guarded_read.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_io.h"
#include "formats/opal_asset_metadata.h"
#include "formats/opal_asset_sites.h"
#include "formats/opal_file_checksum.h"

namespace opal {
namespace {

/// Each id up to the largest takes an orientation in memory.
constexpr std::int32_t largest_grain_id = 50'000'000;

/// Clients may leave ids in the background or in inactive voxels, and zeros in active ones; the walk through the grains reads
/// values alone.
void empty_outside(openvdb::Int32Grid& ids) {
    openvdb::tools::changeBackground(ids.tree(), 0);
    openvdb::tools::foreach (ids.beginValueOff(), [](const openvdb::Int32Grid::ValueOffIter& value) {
        if (*value != 0) value.setValue(0);
    });
    openvdb::tools::foreach (ids.beginValueOn(), [](const openvdb::Int32Grid::ValueOnIter& value) {
        if (*value == 0) value.setValueOff();
    });
}

openvdb::Int32Grid::Ptr as_grain_ids(const openvdb::GridBase::Ptr& base, const std::string& file,
                                     std::vector<std::string>& notices) {
    if (const auto ids = openvdb::gridPtrCast<openvdb::Int32Grid>(base)) {
        empty_outside(*ids);
        // Converters take the class at its word.
        ids->setGridClass(openvdb::GRID_UNKNOWN);
        return ids;
    }
    const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
    if (!floats)
        throw InputError(fmt::format("{}: grid grain_id has type {}; allowed: int32, or float holding whole numbers", file,
                                     base->valueType()));
    auto ids = openvdb::Int32Grid::create(0);
    ids->setTransform(floats->transform().copy());
    auto accessor = ids->getAccessor();
    for (auto value = floats->cbeginValueOn(); value; ++value) {
        const float id = value.getValue();
        if (id == 0.0f) continue;
        if (!(id >= 0.0f && id < 2.0e9f) || std::abs(id - std::round(id)) > 1.0e-3f)
            throw InputError(fmt::format("{}: grid grain_id: voxel [{}, {}, {}] holds {}; allowed: whole numbers from 0", file,
                                         value.getCoord().x(), value.getCoord().y(), value.getCoord().z(), id));
        if (value.isTileValue())
            ids->tree().addTile(value.getLevel(), value.getCoord(), std::int32_t(std::lround(id)), true);
        else
            accessor.setValueOn(value.getCoord(), std::int32_t(std::lround(id)));
    }
    notices.push_back("grain_id is a float grid: its values were rounded to whole numbers");
    return ids;
}

void require_plain_transform(const openvdb::GridBase& grid, const std::string& file) {
    const openvdb::math::Transform& transform = grid.transform();
    bool plain = transform.isLinear() && transform.hasUniformScale();
    if (plain) {
        const openvdb::Mat4R matrix = transform.baseMap()->getAffineMap()->getMat4();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                plain = plain && (i == j ? matrix[i][j] > 0.0 : std::abs(matrix[i][j]) < 1.0e-9 * matrix[i][i]);
    }
    if (!plain)
        throw InputError(
            fmt::format("{}: grid {}: its transform is not a uniform scale with a translation", file, grid.getName()));
}

std::int32_t require_valid_ids(const openvdb::Int32Grid& grid, const std::string& file) {
    std::int32_t largest = 0;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        if (*value < 0)
            throw InputError(fmt::format("{}: grid grain_id: voxel [{}, {}, {}] holds {}; allowed: ids from 1 (0 is outside)",
                                         file, value.getCoord().x(), value.getCoord().y(), value.getCoord().z(), *value));
        largest = std::max(largest, *value);
    }
    if (largest == 0) throw InputError(fmt::format("{}: grid grain_id: no voxel holds a grain", file));
    if (largest > largest_grain_id)
        throw InputError(fmt::format("{}: grid grain_id: holds id {}; allowed: ids up to {} (number the grains from 1)", file,
                                     largest, largest_grain_id));
    return largest;
}

void draw_orientations(OpalAsset& asset, std::size_t num_grains, std::uint64_t seed, bool foreign) {
    for (std::size_t grain = 1; grain <= num_grains; ++grain)
        asset.grain_orientations.push_back(random_orientation(seed, foreign, grain));
}

void require_valid_shape(const openvdb::FloatGrid& shape, const std::string& file) {
    if (shape.getGridClass() != openvdb::GRID_LEVEL_SET)
        throw InputError(fmt::format("{}: grid shape: not marked as a level set", file));
    if (!(shape.background() > 0.0f))
        throw InputError(fmt::format("{}: grid shape: its background must be positive (outside)", file));
    bool inside = false;
    for (auto value = shape.cbeginValueOn(); value; ++value) {
        if (!std::isfinite(*value))
            throw InputError(fmt::format("{}: grid shape: voxel [{}, {}, {}] holds {}", file, value.getCoord().x(),
                                         value.getCoord().y(), value.getCoord().z(), *value));
        inside = inside || *value < 0.0f;
    }
    if (!inside) throw InputError(fmt::format("{}: grid shape: has no inside (no negative values)", file));
}

/// An optional grid of floats that lie in [lowest, infinity); null where the file has none.
openvdb::FloatGrid::Ptr read_field(const RawOpalFile& raw, const char* name, float lowest, const std::string& file) {
    const openvdb::GridBase::Ptr base = raw.find(name);
    if (!base) return nullptr;
    const auto field = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
    if (!field) throw InputError(fmt::format("{}: grid {} has type {}; allowed: float", file, name, base->valueType()));
    require_plain_transform(*field, file);
    if (!(field->background() >= lowest && std::isfinite(field->background())))
        throw InputError(fmt::format("{}: grid {}: its background is {}", file, name, field->background()));
    // Interpolation reads inactive voxels too.
    for (auto value = field->cbeginValueAll(); value; ++value)
        if (!(*value >= lowest && std::isfinite(*value)))
            throw InputError(fmt::format("{}: grid {}: voxel [{}, {}, {}] holds {}; allowed: {}", file, name,
                                         value.getCoord().x(), value.getCoord().y(), value.getCoord().z(), *value,
                                         lowest == 0.0f ? "numbers from 0" : "finite numbers"));
    return field;
}

void read_fields(const RawOpalFile& raw, const std::string& file, OpalAsset& asset) {
    asset.weight = read_field(raw, grid_names::weight, std::numeric_limits<float>::lowest(), file);
    asset.sigma_a_scale = read_field(raw, grid_names::sigma_a_scale, 0.0f, file);
    asset.sigma_s_rayleigh_400nm = read_field(raw, grid_names::sigma_s_rayleigh, 0.0f, file);
    asset.sigma_s_mie = read_field(raw, grid_names::sigma_s_mie, 0.0f, file);
}

void read_shape(const RawOpalFile& raw, const std::string& file, OpalAsset& asset, std::vector<std::string>& notices) {
    if (const auto shape = openvdb::gridPtrCast<openvdb::FloatGrid>(raw.find(grid_names::shape))) {
        require_plain_transform(*shape, file);
        require_valid_shape(*shape, file);
        asset.shape = shape;
    } else if (asset.grain_id) {
        asset.shape = openvdb::tools::topologyToLevelSet(*asset.grain_id, 3, 1, 0, 4);
        notices.push_back("no level set named shape: the surface was made from the labelled voxels, smoothed");
    }
}

/// Orientations of a file without sites.
void read_orientations_without_sites(const StatedGrains& stated, const ReadOpalOptions& options, OpalAsset& asset,
                                     std::vector<std::string>& notices) {
    if (!stated.orientations.empty()) {
        asset.grain_orientations = stated.orientations;
    } else if (asset.schema_version > 0 && stated.from_seed) {
        draw_orientations(asset, stated.num_grains, asset.seed, false);
    } else {
        draw_orientations(asset, stated.num_grains, options.orientation_seed, true);
        notices.push_back(
            fmt::format("{}: the {} grains' orientations were drawn from seed {}",
                        asset.schema_version > 0 ? "the sites, which held the orientations, are not there" : "no sites",
                        stated.num_grains, options.orientation_seed));
    }
}

std::string names_of(const RawOpalFile& raw) {
    std::string names;
    for (const auto& grid : raw.grids) names += (names.empty() ? "" : ", ") + grid->getName();
    return names.empty() ? "no grids" : names;
}

OpalAsset checked_asset(const RawOpalFile& raw, const std::string& file, const ReadOpalOptions& options,
                        std::vector<std::string>& notices) {
    const openvdb::GridBase::Ptr ids = raw.find(grid_names::grain_id);
    const auto sites = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(raw.find(grid_names::sites));
    if (!ids && !sites) throw InputError(fmt::format("{}: no grid named grain_id (found: {})", file, names_of(raw)));
    OpalAsset asset;
    std::size_t largest_id = 0;
    if (ids) {
        asset.grain_id = as_grain_ids(ids, file, notices);
        require_plain_transform(*asset.grain_id, file);
        largest_id = std::size_t(require_valid_ids(*asset.grain_id, file));
    } else {
        largest_id = count_grains_of_sites(*sites, file);
    }

    StatedGrains stated;
    if (has_opal_metadata(raw.metadata)) {
        stated = read_opal_metadata(raw.metadata, file, asset);
        if (stated.num_grains < largest_id)
            throw InputError(fmt::format("{}: grid {} holds id {}, but the file states {} grains", file,
                                         ids ? grid_names::grain_id : grid_names::sites, largest_id, stated.num_grains));
    } else {
        stated.num_grains = largest_id;
        asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.25);
        notices.push_back("made elsewhere: no opal metadata, so crystal and body colour are the recipe's defaults");
    }
    read_shape(raw, file, asset, notices);
    read_fields(raw, file, asset);
    if (sites)
        read_sites(*sites, asset, stated.num_grains, file);
    else
        read_orientations_without_sites(stated, options, asset, notices);
    if (!options.with_sites) asset.sites.clear();
    return asset;
}

/// OpenVDB warns of files that are newer than itself, and then reads them as if they were not.
void require_known_version(std::istream& stream, const std::filesystem::path& path) {
    std::int64_t magic = 0;
    std::uint32_t version = 0;
    stream.read(reinterpret_cast<char*>(&magic), sizeof magic);
    stream.read(reinterpret_cast<char*>(&version), sizeof version);
    stream.seekg(0);
    if (magic == openvdb::OPENVDB_MAGIC && version > openvdb::OPENVDB_FILE_VERSION)
        throw InputError(fmt::format("{}: .vdb of version {}; versions up to {} can be read", path.string(), version,
                                     std::uint32_t(openvdb::OPENVDB_FILE_VERSION)));
}

void read_grids(const std::filesystem::path& path, RawOpalFile& raw) {
    std::ifstream stream(path, std::ios::binary);
    // Without exceptions a truncated file would be read as zeros.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    require_known_version(stream, path);
    openvdb::io::Stream archive(stream, /*delayLoad=*/false);
    raw.grids = *archive.getGrids();
    raw.metadata = *archive.getMetadata();
}

}  // namespace

RawOpalFile read_raw_opal_file(const std::filesystem::path& path) {
    initialize_openvdb();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw InputError(fmt::format("{}: no such file", path.string()));
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(fmt::format("{}: is not a file", path.string()));
    RawOpalFile raw;
    if (!std::ifstream(path, std::ios::binary))
        throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    const Checksum checksum = look_at_checksum(path);
    if (checksum == Checksum::differs)
        throw InputError(
            fmt::format("{}: not a complete .vdb file, or a damaged one: its checksum does not fit its content", path.string()));
    // OpenVDB trusts the bytes: lengths in compressed blocks, damaged, lead it outside its memory.
    // What was written outside of it often shows only where memory is given back: the trial is destroyed there too.
    if (checksum == Checksum::none)
        require_no_crash(path, [&] {
            for (int times = 0; times < 2; ++times) {
                RawOpalFile trial;
                read_grids(path, trial);
            }
        });
    try {
        read_grids(path, raw);
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError(
            fmt::format("{}: damaged, or larger than memory: a length in it asks for more memory than there is", path.string()));
    } catch (const std::length_error&) {
        throw InputError(fmt::format("{}: damaged: a length in it is impossible", path.string()));
    } catch (const std::ios_base::failure&) {
        throw InputError(
            fmt::format("{}: not a complete .vdb file: it ends too early, or a length in it is damaged", path.string()));
    } catch (const std::exception& exception) {
        throw InputError(fmt::format("{}: not a complete .vdb file: {}", path.string(), exception.what()));
    }
    return raw;
}

openvdb::GridBase::Ptr RawOpalFile::find(const std::string& name) const {
    for (const auto& grid : grids)
        if (grid->getName() == name) return grid;
    return nullptr;
}

OpalAsset read_opal_asset(const std::filesystem::path& path, const ReadOpalOptions& options, std::vector<std::string>& notices) {
    return asset_from_raw(read_raw_opal_file(path), path.string(), options, notices);
}

OpalAsset asset_from_raw(const RawOpalFile& raw, const std::string& file, const ReadOpalOptions& options,
                         std::vector<std::string>& notices) {
    try {
        return checked_asset(raw, file, options, notices);
    } catch (const openvdb::Exception& exception) {
        // Attributes and grids of another type than their name promises.
        throw InputError(fmt::format("{}: {}", file, exception.what()));
    }
}

}  // namespace opal
