// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

namespace opal {

/// A half-space that holds all places x with normal.x <= offset_mm.
struct BoundingPlane {
    openvdb::Vec3d normal;  ///< unit length, outward
    double offset_mm;
};

/// A convex polyhedron about whatever it is told to hold, with faces in 102 fixed directions: those of a box first (+x, -x, +y,
/// -y, +z, -z), then 96 that are no more than 18 degrees from any direction.
class ConvexBounds {
  public:
    ConvexBounds();

    void hold(const openvdb::Vec3d& place_mm);
    /// The voxels of a level set that are inside.
    void hold_inside(const openvdb::FloatGrid& shape);
    void widen(double margin_mm);

    const std::vector<BoundingPlane>& planes() const { return planes_; }
    openvdb::BBoxd box_mm() const;

  private:
    std::vector<BoundingPlane> planes_;
};

}  // namespace opal
