// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>
#include <vector>

#include "formats/opal_asset.h"

namespace opal {

/// What a section shows. The last three and `weight` are fields, the others belong to grains.
enum class SectionColor { grain, orientation, sites, weight, sigma_a_scale, sigma_s_rayleigh, sigma_s_mie };

/// The colourings' names on the command line, in the order of the enumeration.
const std::vector<std::string>& section_color_names();
bool is_field(SectionColor color);

/// A plane perpendicular to an axis of the world, laid out as pixels. Seen from the axis's positive end, but for y, which is seen
/// along +y, so that x runs to the right in sections across y and z, and z upwards in sections across x and y.
struct SectionFrame {
    int axis = 2;    ///< the plane's normal: 0 x, 1 y, 2 z
    int across = 0;  ///< the world axis that runs to the right
    int up = 1;      ///< the world axis that runs upwards
    double at_mm = 0.0;
    double left_mm = 0.0;  ///< `across` coordinate of the left edge
    double top_mm = 0.0;   ///< `up` coordinate of the upper edge
    double pixel_mm = 1.0;
    int width = 0;
    int height = 0;

    /// The point at continuous pixel coordinates: the first pixel's middle is (0.5, 0.5), rows run downwards.
    openvdb::Vec3d point_mm(double column, double row) const;
    /// The other way round; the third coordinate is the distance in front of the plane, in mm.
    openvdb::Vec3d pixel_of(const openvdb::Vec3d& point_mm) const;
};

/// Where sections across an axis can lie: from the first to the last layer of voxels that holds a grain, in mm.
struct SectionRange {
    double low_mm, high_mm;
};
SectionRange section_range_mm(const OpalAsset& asset, int axis);

/// Extent of the labelled voxels in mm, from face to face.
openvdb::BBoxd voxel_bounds_mm(const OpalAsset& asset);

/// A frame of width x height pixels around the middle of the opal's extent.
SectionFrame centered_frame(const OpalAsset& asset, int axis, double at_mm, double pixel_mm, int width, int height);

/// Samples of a section, `oversampling` to a pixel along each side.
struct SectionRaster {
    int width = 0;
    int height = 0;
    int oversampling = 1;
    std::vector<std::int32_t> label;  ///< 0 outside; inside the grain's id, for fields 1
    std::vector<float> value;         ///< fields: the field inside; else empty

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
    }
};

/// Cuts the opal: the outline is that of the level set, a grain's id that of the nearest voxel, a field is interpolated linearly;
/// `weight` is the weight of the nearest site where the file holds no such grid. Throws InputError where the field is not in the
/// file.
SectionRaster sample_section(const OpalAsset& asset, const SectionFrame& frame, SectionColor color, int oversampling);

/// Which samples lines run through.
enum class SectionLine : std::uint8_t { none, grain_boundary, outline };

/// Lines of half width `half_width` samples between samples of different grains, and twice as wide between inside and outside.
std::vector<SectionLine> trace_lines(const SectionRaster& raster, double half_width);

}  // namespace opal
