// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/convex_bounds.h"

#include <algorithm>
#include <limits>

namespace opal {

ConvexBounds::ConvexBounds() {
    const auto add = [&](int axis, double sign, double u, double v) {
        openvdb::Vec3d normal;
        normal[axis] = sign;
        normal[(axis + 1) % 3] = u;
        normal[(axis + 2) % 3] = v;
        planes_.push_back({normal.unit(), -std::numeric_limits<double>::infinity()});
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) add(axis, sign, 0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0})
            for (const double u : {-0.75, -0.25, 0.25, 0.75})
                for (const double v : {-0.75, -0.25, 0.25, 0.75}) add(axis, sign, u, v);
}

void ConvexBounds::hold(const openvdb::Vec3d& place_mm) {
    for (BoundingPlane& plane : planes_) plane.offset_mm = std::max(plane.offset_mm, plane.normal.dot(place_mm));
}

void ConvexBounds::hold_inside(const openvdb::FloatGrid& shape) {
    for (auto leaf = shape.tree().cbeginLeaf(); leaf; ++leaf) {
        openvdb::CoordBBox inside;
        for (auto value = leaf->cbeginValueOn(); value; ++value)
            if (*value < 0.0f) inside.expand(value.getCoord());
        if (inside.empty()) continue;
        for (int corner = 0; corner < 8; ++corner)
            hold(shape.indexToWorld(openvdb::Vec3d((corner & 1) != 0 ? inside.max().x() : inside.min().x(),
                                                   (corner & 2) != 0 ? inside.max().y() : inside.min().y(),
                                                   (corner & 4) != 0 ? inside.max().z() : inside.min().z())));
    }
}

void ConvexBounds::widen(double margin_mm) {
    for (BoundingPlane& plane : planes_) plane.offset_mm += margin_mm;
}

openvdb::BBoxd ConvexBounds::box_mm() const {
    openvdb::BBoxd box;
    for (int axis = 0; axis < 3; ++axis) {
        box.max()[axis] = planes_[std::size_t(2 * axis)].offset_mm;
        box.min()[axis] = -planes_[std::size_t(2 * axis) + 1].offset_mm;
    }
    return box;
}

}  // namespace opal
