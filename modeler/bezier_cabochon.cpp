// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/bezier_cabochon.h"

#include "modeler/bezier_symmetry.h"

namespace opal {
namespace {

/// 4/3 (sqrt 2 - 1): the cubic meets the quarter circle at its ends and its middle.
constexpr double quarter_circle = 0.55228474983079340;

struct ProfilePoint {
    double radius;  ///< of the outline, in units of the half extents
    double height;  ///< above the girdle, in units of the height there
};

/// Profile times outline: the tensor product of two planar cubics.
void add_side(const ProfilePoint (&profile)[4], const openvdb::Vec3d& half_size_mm, double girdle_mm, double height_mm,
              std::vector<BezierPatch>& patches) {
    const double outline[4][2] = {{1.0, 0.0}, {1.0, quarter_circle}, {quarter_circle, 1.0}, {0.0, 1.0}};
    BezierNet net;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            net[i][j][0] = profile[i].radius * outline[j][0];
            net[i][j][1] = profile[i].radius * outline[j][1];
            net[i][j][2] = girdle_mm + height_mm * profile[i].height;
        }
    const std::size_t first = patches.size();
    add_turned_patches(net, 0, patches);
    for (std::size_t n = first; n < patches.size(); ++n)
        for (auto& row : patches[n].control_mm)
            for (auto& point : row) {
                point[0] *= half_size_mm.x();
                point[1] *= half_size_mm.y();
            }
}

}  // namespace

std::vector<BezierPatch> bezier_cabochon(const openvdb::Vec3d& size_mm, double girdle_mm) {
    const double k = quarter_circle;
    const ProfilePoint dome[4] = {{0.0, 1.0}, {k, 1.0}, {1.0, k}, {1.0, 0.0}};
    const ProfilePoint round_base[4] = {{1.0, 0.0}, {1.0, -k}, {k, -1.0}, {0.0, -1.0}};
    const ProfilePoint flat_base[4] = {{1.0, 0.0}, {2.0 / 3.0, 0.0}, {1.0 / 3.0, 0.0}, {0.0, 0.0}};
    std::vector<BezierPatch> patches;
    add_side(dome, 0.5 * size_mm, girdle_mm, size_mm.z() - girdle_mm, patches);
    add_side(girdle_mm > 0.0 ? round_base : flat_base, 0.5 * size_mm, girdle_mm, girdle_mm, patches);
    return patches;
}

}  // namespace opal
