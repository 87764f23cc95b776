// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/float_grid_file.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <vector>

#include "formats/error.h"
#include "formats/opal_asset_io.h"
#include "formats/text.h"

namespace opal {

openvdb::FloatGrid::Ptr read_float_grid(const std::filesystem::path& file, const std::string& name) {
    const RawOpalFile raw = read_raw_opal_file(file);
    std::vector<std::string> float_names;
    openvdb::FloatGrid::Ptr found;
    for (const openvdb::GridBase::Ptr& base : raw.grids) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        if (!grid) continue;
        float_names.push_back(grid->getName());
        if (name.empty() || grid->getName() == name) found = grid;
    }
    const std::string present = float_names.empty() ? "none" : join(float_names);
    if (!found && !name.empty())
        throw InputError(fmt::format("{}: no float grid named '{}' (float grids: {}){}", file.string(), name, present,
                                     did_you_mean(name, float_names)));
    if (!found || (name.empty() && float_names.size() > 1))
        throw InputError(
            fmt::format("{}: grid = \"NAME\" must say which float grid to take (float grids: {})", file.string(), present));
    return found;
}

double sample_float_grid(const openvdb::FloatGrid& grid, const openvdb::Vec3d& place_mm, const std::filesystem::path& file) {
    const auto value =
        static_cast<double>(openvdb::tools::BoxSampler::sample(grid.constTree(), grid.transform().worldToIndex(place_mm)));
    if (!std::isfinite(value))
        throw InputError(fmt::format("{}: grid '{}' holds {} at [{:.6g}, {:.6g}, {:.6g}] mm", file.string(), grid.getName(),
                                     value, place_mm.x(), place_mm.y(), place_mm.z()));
    return value;
}

}  // namespace opal
