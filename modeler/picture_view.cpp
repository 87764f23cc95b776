// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/picture_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "formats/animation.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr double margin_part = 0.05;
constexpr int most_frames = 64;

openvdb::Vec3d rotated(openvdb::Vec3d v, const std::array<double, 3>& rotate_deg) {
    for (int axis = 0; axis < 3; ++axis) {
        const double angle_rad = units::rad_from_deg(rotate_deg[static_cast<std::size_t>(axis)]);
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double va = std::cos(angle_rad) * v[a] - std::sin(angle_rad) * v[b];
        v[b] = std::sin(angle_rad) * v[a] + std::cos(angle_rad) * v[b];
        v[a] = va;
    }
    return v;
}

}  // namespace

PictureView::PictureView(const SceneDescription& scene, const ObjectDescription& opal)
    : camera_(scene.camera),
      scale_(opal.scale),
      rotate_deg_(opal.rotate_deg),
      translate_mm_(opal.translate_mm.data()),
      position_mm_(scene.camera.position_mm.data()),
      forward_((openvdb::Vec3d(scene.camera.target_mm.data()) - position_mm_).unitSafe()),
      right_(forward_.cross(openvdb::Vec3d(scene.camera.up.data())).unitSafe()),
      down_(forward_.cross(right_)),
      width_px_(scene.render.width),
      height_px_(scene.render.height),
      margin_px_(margin_part * std::max(width_px_, height_px_) + scene.render.filter_radius_px) {}

double PictureView::nearest_footprint_mm(const openvdb::BBoxd& bounds_mm) const {
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner) {
        openvdb::Vec3d point_mm;
        for (int axis = 0; axis < 3; ++axis)
            point_mm[axis] = (corner >> axis & 1) != 0 ? bounds_mm.max()[axis] : bounds_mm.min()[axis];
        nearest_mm = std::min(nearest_mm, from_camera_mm(point_mm).dot(forward_));
    }
    return footprint_mm(nearest_mm);
}

double PictureView::footprint_in_picture_mm(const openvdb::Vec3d& point_mm) const {
    const openvdb::Vec3d offset_mm = from_camera_mm(point_mm);
    const double depth_mm = offset_mm.dot(forward_), pixel_mm = picture_height_mm(depth_mm) / height_px_;
    const bool beside = std::abs(offset_mm.dot(right_)) > (0.5 * width_px_ + margin_px_) * pixel_mm ||
                        std::abs(offset_mm.dot(down_)) > (0.5 * height_px_ + margin_px_) * pixel_mm;
    return depth_mm <= 0.0 || beside ? std::numeric_limits<double>::infinity() : footprint_mm(depth_mm);
}

openvdb::Vec3d PictureView::from_camera_mm(const openvdb::Vec3d& point_mm) const {
    return rotated(point_mm * scale_, rotate_deg_) + translate_mm_ - position_mm_;
}

double PictureView::picture_height_mm(double depth_mm) const {
    if (camera_.kind != CameraKind::perspective) return camera_.view_height_mm;
    return 2.0 * std::max(0.0, depth_mm) * std::tan(0.5 * units::rad_from_deg(camera_.vertical_fov_deg));
}

double PictureView::footprint_mm(double depth_mm) const {
    return picture_height_mm(depth_mm) / height_px_ / scale_;
}

std::vector<PictureView> picture_views(const SceneDescription& scene, const std::vector<std::size_t>& objects) {
    std::vector<PictureView> views;
    const int frames = scene.animation.frames, shown = std::min(frames, most_frames);
    for (int k = 0; k < shown; ++k) {
        const int frame = shown == 1 ? 1 : 1 + int(std::lround(double(k) * (frames - 1) / (shown - 1)));
        const SceneDescription still = scene_of_frame(scene, frame);
        for (const std::size_t object : objects) views.emplace_back(still, still.objects[object]);
    }
    return views;
}

}  // namespace opal
