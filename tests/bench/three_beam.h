// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opal {

/// A plane-parallel slab in which a beam is coupled to two others that both leave it through the face where the first comes in:
/// amplitudes A (scaled so that |A|^2 is the flux through the faces) over the depth z, 0 to 1 slab thickness,
///   A0' = i (k1 A1 + k2 A2),  A1' = -i (k1 A0 + c A2 + 2 d1 A1),  A2' = -i (k2 A0 + c A1 + 2 d2 A2).
/// Scalar three-beam dynamical theory (two reciprocal vectors near the Ewald sphere; Authier, "Dynamical Theory of X-ray
/// Diffraction", 2001, chapter 9). With c = k2 = 0: the two-beam reflectance of kappa t = k1 and delta t = d1.
struct ThreeBeamSlab {
    double coupling[2];  ///< k1, k2: kappa t of the two families
    double cross;        ///< c: coupling of the two reflected beams by the difference of their reciprocal vectors
    double detuning[2];  ///< d1, d2: delta t
};

/// Part of the light that leaves by the two reflected beams together.
double three_beam_reflectance(const ThreeBeamSlab& slab);

}  // namespace opal
