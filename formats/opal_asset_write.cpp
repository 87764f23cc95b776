// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <openvdb/io/Archive.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "formats/atomic_file.h"
#include "formats/display_twins.h"
#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_metadata.h"
#include "formats/opal_asset_sites.h"
#include "formats/opal_file_checksum.h"

namespace opal {
namespace {

/// io::File does not notice a full disk; this archive writes the same bytes through a stream whose errors we see.
class CheckedArchive : public openvdb::io::Archive {
  public:
    void write_all(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
        setCompression(openvdb::io::COMPRESS_ACTIVE_MASK |
                       (hasBloscCompression() ? openvdb::io::COMPRESS_BLOSC : openvdb::io::COMPRESS_ZIP));
        Archive::write(stream, grids, /*seekable=*/true, metadata);
    }
};

/// The file's grids, in its order. The asset's own are shared, not copied.
class GridList {
  public:
    template <typename GridPtr>
    void add(const GridPtr& grid, const char* name) {
        if (!grid) return;
        const GridPtr named = grid->copy();
        named->setName(name);
        named->setCreator("opal-model");
        grids_.push_back(named);
    }
    const openvdb::GridCPtrVec& grids() const { return grids_; }

  private:
    openvdb::GridCPtrVec grids_;
};

void require_twins_possible(const OpalAsset& asset, bool with_grain_id, const std::filesystem::path& path) {
    if (!with_grain_id)
        throw InputError(fmt::format("{}: display twins are made from grain_id, which is not to be written", path.string()));
    if (asset.num_grains() > std::size_t(largest_id_in_float))
        throw InputError(fmt::format("{}: {} grains are too many for a float twin of grain_id; at most {}", path.string(),
                                     asset.num_grains(), largest_id_in_float));
}

GridList grids_to_write(const OpalAsset& asset, const WriteOpalOptions& options, const std::filesystem::path& path) {
    const auto wanted = [&](OutputGrid grid) {
        return std::find(options.grids.begin(), options.grids.end(), grid) != options.grids.end();
    };
    const bool with_grain_id = asset.grain_id && wanted(OutputGrid::grain_id);
    const bool with_sites = !asset.sites.empty() && wanted(OutputGrid::sites);
    if (!with_grain_id && !with_sites)
        throw InputError(fmt::format("{}: a file needs grain_id or sites to hold an opal", path.string()));
    if (options.display_twins) require_twins_possible(asset, with_grain_id, path);

    GridList list;
    if (with_grain_id) list.add(asset.grain_id, grid_names::grain_id);
    if (wanted(OutputGrid::shape)) list.add(asset.shape, grid_names::shape);
    if (wanted(OutputGrid::weight)) list.add(asset.weight, grid_names::weight);
    if (wanted(OutputGrid::fields)) {
        list.add(asset.sigma_a_scale, grid_names::sigma_a_scale);
        list.add(asset.sigma_s_rayleigh_400nm, grid_names::sigma_s_rayleigh);
        list.add(asset.sigma_s_mie, grid_names::sigma_s_mie);
    }
    if (options.display_twins) {
        list.add(make_orientation_rgb(*asset.grain_id), grid_names::orientation_rgb);
        list.add(make_grain_id_float(*asset.grain_id), grid_names::grain_id_float);
    }
    if (with_sites) list.add(sites_to_points(asset), grid_names::sites);
    return list;
}

}  // namespace

void write_opal_asset(const OpalAsset& asset, const std::filesystem::path& path, const WriteOpalOptions& options) {
    initialize_openvdb();
    AtomicFile file(path);
    const GridList list = grids_to_write(asset, options, path);
    const bool with_sites = list.grids().back()->getName() == grid_names::sites;

    errno = 0;
    std::ofstream stream(file.temporary_path(), std::ios::binary);
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    try {
        CheckedArchive archive;
        archive.write_all(stream, list.grids(), opal_metadata(asset, with_sites));
        stream.close();
    } catch (const std::exception&) {
        throw SystemError(fmt::format("{}: writing failed: {}", path.string(), errno ? std::strerror(errno) : "stream error"));
    }
    stamp_checksum(file.temporary_path());
    file.commit();
}

}  // namespace opal
