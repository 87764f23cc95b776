// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "modeler/triangle_mesh.h"

namespace opal {

/// Exact distance to a closed mesh by a tree of boxes, its sign by exact ray predicates (CGAL). Safe from several threads.
class MeshDistance {
  public:
    explicit MeshDistance(const TriangleMesh& solid);
    ~MeshDistance();
    MeshDistance(const MeshDistance&) = delete;
    MeshDistance& operator=(const MeshDistance&) = delete;

    double signed_distance_mm(const openvdb::Vec3d& point_mm) const;
    /// The place on the mesh that is nearest to the point.
    openvdb::Vec3d nearest_point_mm(const openvdb::Vec3d& point_mm) const;
    /// The distances (without signs) of points that all lie within `radius_mm` of `centre_mm`: of the nearest triangle to the
    /// centre, at distance d, follows that only triangles within d + 2 radius of the centre can be nearest to one of them, so
    /// where these are few the tree is searched once for all the points.
    void distances_mm(const openvdb::Vec3d& centre_mm, double radius_mm, const std::vector<openvdb::Vec3d>& points_mm,
                      std::vector<double>& distances_mm) const;
    bool contains(const openvdb::Vec3d& point_mm) const;

  private:
    struct Search;
    std::unique_ptr<Search> search_;
};

}  // namespace opal
