// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/core/crystal.h"

namespace opal {

/// Order of close-packed layers that repeat the sense of the last step (A to B to C ...) except with the probability `fault`,
/// each time: 0 is fcc, 0.5 random stacking, 1 hcp. For a rod of reciprocal space whose layers differ in phase by +-2 pi/3 per
/// step, the mean of exp(i phase) over m layers is w1 l1^m + w2 l2^m, with the eigenvalues l of a Markov chain over the sense
/// (Hendricks & Teller, "X-ray interference in partially ordered layer lattices", J. Chem. Phys. 10, 1942): each eigenvalue is a
/// peak on the rod at the phase of l, as sharp as |l| is near 1.
struct StackingPeak {
    double turns;        ///< phase per layer over 2 pi, in [0, 1)
    double weight;       ///< part of the rod's intensity
    double correlation;  ///< r of the peak (1 - r^2) / (1 + r^2 - 2 r cos phase): what is left of the order from layer to layer
    bool separate_domains;  ///< peaks of twins, which share the volume
};

/// Intensity per layer on a rod that faults blur, at a phase per layer over 2 pi: the sum over all distances between layers,
/// exactly.
double rod_intensity(double fault, double turns);

/// The peaks of the rods that faults blur: together as high as rod_intensity where they stand.
std::vector<StackingPeak> stacking_peaks(double fault);

/// Distance of close-packed layers of spheres.
double stacked_layer_nm(double sphere_diameter_nm);

/// All families of planes with |G| <= 2 n_eff / lambda_min. Without faults those of fcc, shortest first. With faults, along the
/// stacking axis [111]: the rods that every layer meets in phase keep sharp reflections; the others have those of stacking_peaks,
/// whose blocks are D (1 + r) / (1 - r) thick in the mean (D the layers' distance): the interference function of that many layers
/// is as high as the peak on the rod. Twins share the volume and are marked as such; peaks of one and the same crystal share the
/// amplitude.
std::vector<PlanePair> stacked_pairs(const CrystalParameters& crystal, double fault, double wavelength_min_nm);

}  // namespace opal
