// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "formats/scene.h"

namespace opal {

/// What a scene's camera sees of an opal, in the opal's own space.
class PictureView {
  public:
    PictureView(const SceneDescription& scene, const ObjectDescription& opal);

    /// Edge (mm of the opal) of a pixel's share of the picture at the depth of the box's corner that is nearest to the camera; 0
    /// where the box reaches behind the camera.
    double nearest_footprint_mm(const openvdb::BBoxd& bounds_mm) const;
    /// The same at a point; infinite where the picture, with a margin of 5 % and the pixel filter's reach, does not show it.
    /// Whether something is in front of the point does not matter: opals are seen through.
    double footprint_in_picture_mm(const openvdb::Vec3d& point_mm) const;

  private:
    openvdb::Vec3d from_camera_mm(const openvdb::Vec3d& point_mm) const;
    double picture_height_mm(double depth_mm) const;
    double footprint_mm(double depth_mm) const;

    CameraDescription camera_;
    double scale_;
    std::array<double, 3> rotate_deg_;
    openvdb::Vec3d translate_mm_, position_mm_, forward_, right_, down_;
    double width_px_, height_px_, margin_px_;
};

/// The views of all frames of a scene's animation (of up to 64 of them, evenly spread), of every object that is the opal.
std::vector<PictureView> picture_views(const SceneDescription& scene, const std::vector<std::size_t>& objects);

}  // namespace opal
