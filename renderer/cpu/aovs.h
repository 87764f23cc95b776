// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/image.h"
#include "renderer/cpu/embree_scene.h"
#include "renderer/host/host_scene.h"

namespace opal {

/// Adds the requested channels (scene key film.aovs) to a picture, or to the part of one. From one ray through each pixel's
/// centre, from the middle of the lens:
///  - object_id: index in the scene, -1 for none
///  - grain_id: grain under an opal's surface; 0 for none
///  - depth: mm along the ray, 0 for none
///  - normal.X .Y .Z: shading normal, world
///  - hkl.h .k .l: Miller indices of the first diffraction: the ray is refracted straight on (at 550 nm) to the first grain in
///    which a family turns at least a thousandth of white light; there the family that turns most, with the sign of the
///    reciprocal vector that turns it; 0 0 0 for none. Of stacked crystals: hexagonal H, K and the order along the stacking
///    axis. hkl.wavelength_nm: mean wavelength of what it turns.
/// Averaged over 16 places of each pixel:
///  - albedo.R .G .B: linear sRGB of the reflectance of what is met, under the scene's illuminant (metals at normal incidence,
///    plastic by its base); 1 for transparent bodies, 0 for none
/// sample_count and variance.R .G .B are in every picture; naming them adds nothing.
void add_aovs(const HostScene& scene, const EmbreeScene& intersector, const std::vector<std::string>& aovs, Image& image);

}  // namespace opal
