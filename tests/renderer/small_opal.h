// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formats/opal_asset.h"
#include "renderer/cpu/render_picture.h"

namespace opal {

/// An opal made in the test itself, without the modeler: a ball (or a slab) of voxels labelled by the nearest of `grains` random
/// points.
struct SmallOpal {
    double radius_mm = 3.0;
    double half_thickness_mm =
        0.0;  ///< above 0: a square slab of that half thickness and half width `radius_mm` instead of a ball
    double voxel_mm = 0.1;
    int grains = 40;
    OpalConstants constants;
    /// Over the place in mm, in voxels of `field_voxel_mm`; unset: the constant. Order: sigma_a_scale, sigma_s_rayleigh_400nm,
    /// sigma_s_mie.
    std::array<std::function<double(const openvdb::Vec3d&)>, 3> fields;
    double field_voxel_mm = 0.25;

    SmallOpal();
    OpalAsset make() const;
};

/// A field with `value` at all voxels whose centres lie in a box (mm), background 0.
openvdb::FloatGrid::Ptr box_field(const openvdb::BBoxd& box_mm, double voxel_mm,
                                  const std::function<double(const openvdb::Vec3d&)>& value);

/// A folder that is removed at the end.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

struct Rendered {
    Image image;
    RenderOutcome outcome;
};

/// Renders a scene given as TOML (file names relative to `folder`'s files through absolute paths). `backend`: see backends.h.
Rendered render_text(const std::string& scene_toml, int samples, const char* backend = "cpu");

/// Mean and standard error over the pixels [x0, x1) x [y0, y1) of a channel, from the stored variances.
struct MeanEstimate {
    double mean, standard_error;
};
MeanEstimate region_mean(const Image& image, const std::string& channel, int x0, int y0, int x1, int y1);

}  // namespace opal
