// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/light_shapes.h"
#include "renderer/host/mesh_data.h"

/// Whether surfaces touch flat or round things: where a light or a camera's lens stands partly inside a body. Only the surface
/// counts: a thing that lies wholly inside touches nothing.
namespace opal {

/// The rectangle `centre` +- half_x +- half_y, its edges at right angles; touched as well by what comes as near as `margin_mm`,
/// and as the rounding of coordinates.
bool touches_rectangle(const MeshData& mesh, Vec3 centre, Vec3 half_x, Vec3 half_y, double margin_mm);

/// A light, the ball of a sphere light included; the sun is never touched. As near as the rounding of coordinates counts.
bool touches_light(const MeshData& mesh, const LightGeometry& light);

}  // namespace opal
