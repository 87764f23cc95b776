// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/optics/crystal_optics.h"
#include "renderer/optics/transfer_matrix.h"

namespace opal {

/// Part of the layer between the heights `low_nm` < `high_nm` over a plane of sphere centres that lies inside spheres, for the
/// crystal's planes parallel to (hkl): a sum of slices of balls, since every plane holds one sphere per area V / D (V the volume
/// per sphere, D the distance of neighbouring planes of centres).
double plane_filling(const CrystalOptics& crystal, const PlaneFamily& planes, double low_nm, double high_nm);

/// The permittivity of `count` planes of whole spheres in the medium, from the front of the first spheres to the back of the
/// last, as films of 1 / `slices` of the distance of two planes.
std::vector<Film> plane_averaged_slab(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm, long count,
                                      int slices);

/// One period of the plane-averaged permittivity along the normal of (hkl), cut midway between two planes of centres, as `slices`
/// equal films, each with the mean over its thickness.
std::vector<Film> plane_averaged_period(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm,
                                        int slices);

}  // namespace opal
