// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

#include "formats/opal_asset.h"
#include "renderer/core/cell_field.h"
#include "renderer/host/convex_bounds.h"

namespace opal {

/// Owns the cells that the transport walks, made from the sites of an additive or Voronoi tessellation (weights 0) without
/// boundary noise.
class CellData {
  public:
    /// `bounds` (object space) hold every place that rays will reach; sites may lie outside. Sites of grain 0 own nothing
    /// and are left out, as are others that turn out to be hidden. At least one site must have a grain. The result does not
    /// depend on the number of threads.
    CellData(const std::vector<Site>& sites, ConvexBounds bounds);

    CellField field() const;
    std::size_t size_bytes() const;

  private:
    void keep_visible(const ConvexBounds& bounds);
    void find_neighbors(const ConvexBounds& bounds);
    void fill_start_grid(const openvdb::BBoxd& box_mm);

    std::vector<CellSite> sites_;
    std::vector<std::int32_t> grain_;
    std::vector<std::uint32_t> first_;
    std::vector<std::int32_t> neighbors_;
    std::vector<std::int32_t> start_site_;
    CellField placement_;  ///< the grid's geometry and the rounding
};

/// Diameter (mm) of a ball as large as each grain, element g - 1 for grain g, from half a million to 4 million places of a
/// lattice in the level set's box, some hundred per site. A grain without a place is given the volume of one.
std::vector<float> grain_sizes_mm(const CellField& cells, const openvdb::FloatGrid& shape, std::size_t num_grains);

}  // namespace opal
