// SPDX-License-Identifier: Apache-2.0
#include "formats/opal_asset.h"

#include <fmt/format.h>
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/TopologyToLevelSet.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/opal_asset_io.h"
#include "formats/random.h"
#include "formats/units.h"
#include "formats_generated/version.h"

namespace opal {
namespace {

using Quat = openvdb::math::Quat<float>;

/// Each id up to the largest takes an orientation in memory.
constexpr std::int32_t largest_grain_id = 50'000'000;

/// io::File does not notice a full disk; this archive writes the same bytes through a stream whose errors we see.
class CheckedArchive : public openvdb::io::Archive {
  public:
    void write_all(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
        setCompression(openvdb::io::COMPRESS_ACTIVE_MASK |
                       (hasBloscCompression() ? openvdb::io::COMPRESS_BLOSC : openvdb::io::COMPRESS_ZIP));
        Archive::write(stream, grids, /*seekable=*/true, metadata);
    }
};

double site_spacing_mm(const std::vector<Site>& sites, double voxel_size_mm) {
    openvdb::BBoxd box;
    for (const Site& site : sites) box.expand(site.position_mm);
    const openvdb::Vec3d extent = sites.empty() ? openvdb::Vec3d(0.0) : box.extents();
    const double volume_mm3 = extent.x() * extent.y() * extent.z();
    return std::max(voxel_size_mm, std::cbrt(volume_mm3 / double(std::max<std::size_t>(1, sites.size()))));
}

template <typename Value>
void fill_attribute(openvdb::points::PointDataTree& tree, const std::string& name,
                    const std::function<Value(std::int32_t id)>& of) {
    openvdb::points::appendAttribute<Value>(tree, name);
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<std::int32_t> id(leaf->constAttributeArray("id"));
        openvdb::points::AttributeWriteHandle<Value> attribute(leaf->attributeArray(name));
        for (openvdb::Index i = 0; i < id.size(); ++i) attribute.set(i, of(id.get(i)));
    }
}

openvdb::points::PointDataGrid::Ptr sites_to_points(const OpalAsset& asset) {
    namespace points = openvdb::points;
    std::vector<openvdb::Vec3d> positions;
    std::vector<std::int32_t> ids;
    for (const Site& site : asset.sites) {
        positions.push_back(site.position_mm);
        ids.push_back(static_cast<std::int32_t>(ids.size()) + 1);
    }
    const points::PointAttributeVector<openvdb::Vec3d> position_list(positions);
    const double voxel_size_mm = asset.grain_id->voxelSize().x();
    const auto transform = openvdb::math::Transform::createLinearTransform(site_spacing_mm(asset.sites, voxel_size_mm));
    const auto index_grid = openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(position_list, *transform);
    auto grid = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index_grid, position_list, *transform);
    const points::PointAttributeVector<std::int32_t> id_list(ids);
    points::appendAttribute<std::int32_t>(grid->tree(), "id");
    points::populateAttribute(grid->tree(), index_grid->tree(), "id", id_list);

    const auto site = [&](std::int32_t id) -> const Site& { return asset.sites[std::size_t(id) - 1]; };
    const float pscale = float(0.25 * site_spacing_mm(asset.sites, voxel_size_mm));
    fill_attribute<std::int32_t>(grid->tree(), "grain", [&](std::int32_t id) { return site(id).grain; });
    fill_attribute<float>(grid->tree(), "weight", [&](std::int32_t id) { return site(id).weight_mm; });
    fill_attribute<float>(grid->tree(), "pscale", [&](std::int32_t) { return pscale; });
    fill_attribute<openvdb::Vec3f>(grid->tree(), "Cd", [&](std::int32_t id) { return grain_display_color(site(id).grain); });
    fill_attribute<Quat>(grid->tree(), "orient", [&](std::int32_t id) {
        return site(id).grain > 0 ? asset.grain_orientations[std::size_t(site(id).grain) - 1] : Quat(0.0f, 0.0f, 0.0f, 1.0f);
    });
    grid->setName(grid_names::sites);
    return grid;
}

openvdb::MetaMap file_metadata(const OpalAsset& asset) {
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
    number(metadata_keys::n_sphere, constants.n_sphere);
    number(metadata_keys::n_medium, constants.n_medium);
    number(metadata_keys::coherence_length_um, constants.coherence_length_um);
    text(metadata_keys::absorber, constants.absorber);
    text(metadata_keys::sigma_a_per_mm, spectrum_to_text(constants.sigma_a_per_mm));
    number(metadata_keys::sigma_s_rayleigh, constants.sigma_s_rayleigh_400nm_per_mm);
    number(metadata_keys::sigma_s_mie, constants.sigma_s_mie_per_mm);
    number(metadata_keys::mie_asymmetry, constants.mie_asymmetry);
    return metadata;
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

OpalConstants read_constants(const MetadataReader& reader, const std::string& file) {
    OpalConstants constants;
    constants.sphere_diameter_nm = reader.number(metadata_keys::sphere_diameter_nm, 50.0, 1000.0);
    constants.n_sphere = reader.number(metadata_keys::n_sphere, 1.0, 4.0);
    constants.n_medium = reader.number(metadata_keys::n_medium, 1.0, 4.0);
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
    return constants;
}

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

void read_sites(const openvdb::points::PointDataGrid& grid, OpalAsset& asset, std::size_t num_grains, const std::string& file) {
    namespace points = openvdb::points;
    const std::size_t count = points::pointCount(grid.tree());
    asset.sites.assign(count, Site{});
    asset.grain_orientations.assign(num_grains, Quat(0.0f, 0.0f, 0.0f, 0.0f));
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        for (const char* name : {"P", "id", "grain", "weight", "orient"})
            if (!leaf->hasAttribute(name)) throw InputError(fmt::format("{}: grid sites: attribute '{}' is missing", file, name));
        const points::AttributeHandle<openvdb::Vec3f> position(leaf->constAttributeArray("P"));
        const points::AttributeHandle<std::int32_t> id(leaf->constAttributeArray("id")),
            grain(leaf->constAttributeArray("grain"));
        const points::AttributeHandle<float> weight(leaf->constAttributeArray("weight"));
        const points::AttributeHandle<Quat> orient(leaf->constAttributeArray("orient"));
        for (auto index = leaf->beginIndexOn(); index; ++index) {
            const std::int32_t site_id = id.get(*index), grain_id = grain.get(*index);
            if (site_id < 1 || std::size_t(site_id) > count || grain_id < 0 || std::size_t(grain_id) > num_grains)
                throw InputError(fmt::format("{}: grid sites: site {} of {} in grain {} of {} is out of range", file, site_id,
                                             count, grain_id, num_grains));
            Site& site = asset.sites[std::size_t(site_id) - 1];
            site.position_mm = grid.indexToWorld(openvdb::Vec3d(position.get(*index)) + index.getCoord().asVec3d());
            site.weight_mm = weight.get(*index);
            site.grain = grain_id;
            if (grain_id > 0) asset.grain_orientations[std::size_t(grain_id) - 1] = orient.get(*index);
        }
    }
    for (std::size_t i = 0; i < num_grains; ++i) {
        const Quat& q = asset.grain_orientations[i];
        const double norm = std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
        if (!(std::abs(norm - 1.0) < 1.0e-3))
            throw InputError(fmt::format("{}: grid sites: grain {} has no unit orientation (norm {:.4g})", file, i + 1, norm));
    }
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

OpalAsset checked_asset(const RawOpalFile& raw, const std::string& file, const ReadOpalOptions& options,
                        std::vector<std::string>& notices) {
    const openvdb::GridBase::Ptr ids = raw.find(grid_names::grain_id);
    if (!ids) {
        std::string found;
        for (const auto& grid : raw.grids) found += (found.empty() ? "" : ", ") + grid->getName();
        throw InputError(fmt::format("{}: no grid named grain_id (found: {})", file, found.empty() ? "no grids" : found));
    }
    OpalAsset asset;
    asset.grain_id = as_grain_ids(ids, file, notices);
    require_plain_transform(*asset.grain_id, file);
    const std::size_t largest_id = std::size_t(require_valid_ids(*asset.grain_id, file));

    const MetadataReader reader(raw.metadata, file);
    std::size_t num_grains = largest_id;
    if (reader.has(metadata_keys::schema_version)) {
        asset.schema_version = reader.integer32(metadata_keys::schema_version);
        if (asset.schema_version < 1 || asset.schema_version > opal_schema_version)
            throw InputError(fmt::format("{}: opal schema {} is not known; this program reads 1 to {}", file,
                                         asset.schema_version, opal_schema_version));
        asset.constants = read_constants(reader, file);
        asset.recipe_toml = reader.text(metadata_keys::recipe);
        asset.program_version = reader.text(metadata_keys::program_version);
        asset.seed = static_cast<std::uint64_t>(reader.integer64(metadata_keys::seed));
        const std::int64_t stated = reader.integer64(metadata_keys::num_grains);
        if (stated < std::int64_t(largest_id) || stated > INT32_MAX)
            throw InputError(
                fmt::format("{}: grid grain_id holds id {}, but the file states {} grains", file, largest_id, stated));
        num_grains = std::size_t(stated);
    } else {
        asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.25);
        notices.push_back("made elsewhere: no opal metadata, so crystal and body colour are the recipe's defaults");
    }

    if (const auto shape = openvdb::gridPtrCast<openvdb::FloatGrid>(raw.find(grid_names::shape))) {
        require_plain_transform(*shape, file);
        require_valid_shape(*shape, file);
        asset.shape = shape;
    } else {
        asset.shape = openvdb::tools::topologyToLevelSet(*asset.grain_id, 3, 1, 0, 4);
        notices.push_back("no level set named shape: the surface was made from the labelled voxels, smoothed");
    }

    const auto sites = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(raw.find(grid_names::sites));
    if (sites && options.with_sites) {
        read_sites(*sites, asset, num_grains, file);
    } else if (asset.schema_version > 0) {
        draw_orientations(asset, num_grains, asset.seed, false);
    } else {
        draw_orientations(asset, num_grains, options.orientation_seed, true);
        notices.push_back(
            fmt::format("no sites: the {} grains' orientations were drawn from seed {}", num_grains, options.orientation_seed));
    }
    return asset;
}

}  // namespace

void initialize_openvdb() {
    openvdb::initialize();
}

openvdb::math::Quat<float> uniform_rotation(std::uint64_t seed, RandomStream stream, std::uint64_t index) {
    const RandomBlock first = random_block(seed, stream, index, 0), second = random_block(seed, stream, index, 1);
    const double u1 = uniform_double(first.value[0], first.value[1]);
    const double angle2 = 2.0 * units::pi * uniform_double(first.value[2], first.value[3]);
    const double angle3 = 2.0 * units::pi * uniform_double(second.value[0], second.value[1]);
    const double a = std::sqrt(1.0 - u1), b = std::sqrt(u1);
    return {float(a * std::sin(angle2)), float(a * std::cos(angle2)), float(b * std::sin(angle3)), float(b * std::cos(angle3))};
}

openvdb::math::Quat<float> random_orientation(std::uint64_t seed, bool foreign, std::uint64_t grain) {
    return uniform_rotation(seed, foreign ? RandomStream::foreign_orientations : RandomStream::grain_orientations, grain);
}

openvdb::Vec3f grain_display_color(std::int32_t grain) {
    if (grain <= 0) return openvdb::Vec3f(0.2f);
    const double hue = 6.0 * (double(grain) * 0.61803398874989485 - std::floor(double(grain) * 0.61803398874989485));
    const auto channel = [&](double offset) {
        const double k = std::fmod(hue + offset, 6.0);
        return float(0.25 + 0.65 * std::clamp(std::abs(k - 3.0) - 1.0, 0.0, 1.0));
    };
    return {channel(0.0), channel(4.0), channel(2.0)};
}

void write_opal_asset(const OpalAsset& asset, const std::filesystem::path& path) {
    initialize_openvdb();
    AtomicFile file(path);
    openvdb::GridCPtrVec grids;
    const openvdb::Int32Grid::Ptr grain_id = asset.grain_id->copy();
    const openvdb::FloatGrid::Ptr shape = asset.shape->copy();
    grain_id->setName(grid_names::grain_id);
    shape->setName(grid_names::shape);
    grids.push_back(grain_id);
    grids.push_back(shape);
    if (!asset.sites.empty()) grids.push_back(sites_to_points(asset));
    for (const auto& grid : grids) std::const_pointer_cast<openvdb::GridBase>(grid)->setCreator("opal-model");

    errno = 0;
    std::ofstream stream(file.temporary_path(), std::ios::binary);
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    try {
        CheckedArchive archive;
        archive.write_all(stream, grids, file_metadata(asset));
        stream.close();
    } catch (const std::exception&) {
        throw SystemError(fmt::format("{}: writing failed: {}", path.string(), errno ? std::strerror(errno) : "stream error"));
    }
    file.commit();
}

RawOpalFile read_raw_opal_file(const std::filesystem::path& path) {
    initialize_openvdb();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw InputError(fmt::format("{}: no such file", path.string()));
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(fmt::format("{}: is not a file", path.string()));
    RawOpalFile raw;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    // Without exceptions a truncated file would be read as zeros.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    try {
        openvdb::io::Stream archive(stream, /*delayLoad=*/false);
        raw.grids = *archive.getGrids();
        raw.metadata = *archive.getMetadata();
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
