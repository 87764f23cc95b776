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
    /// The distance without its sign, which costs less.
    double distance_mm(const openvdb::Vec3d& point_mm) const;
    bool contains(const openvdb::Vec3d& point_mm) const;

  private:
    struct Search;
    std::unique_ptr<Search> search_;
};

}  // namespace opal
