// SPDX-License-Identifier: Apache-2.0
#include "formats/display_twins.h"

#include "formats/grain_map.h"
#include "formats/opal_asset.h"

namespace opal {

openvdb::FloatGrid::Ptr make_grain_id_float(const openvdb::Int32Grid& grain_id) {
    return map_grains<openvdb::FloatGrid>(grain_id, grid_names::grain_id_float,
                                          [](std::int32_t grain) { return static_cast<float>(grain); });
}

openvdb::Vec3SGrid::Ptr make_orientation_rgb(const openvdb::Int32Grid& grain_id) {
    return map_grains<openvdb::Vec3SGrid>(grain_id, grid_names::orientation_rgb, grain_display_color);
}

}  // namespace opal
