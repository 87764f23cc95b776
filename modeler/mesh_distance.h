// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

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
    /// The same, sooner found from a place on the mesh that is known to be near.
    openvdb::Vec3d nearest_point_mm(const openvdb::Vec3d& point_mm, const openvdb::Vec3d& on_surface_mm) const;
    bool contains(const openvdb::Vec3d& point_mm) const;

  private:
    struct Search;
    std::unique_ptr<Search> search_;
};

}  // namespace opal
