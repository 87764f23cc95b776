// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/vec.h"

/// Mosaic spread: the lattice of a grain tilts a little from place to place. Tilts follow the de la Vallee Poussin orientation
/// density (Schaeben, "A simple standard orientation density function: the hyperspherical de la Vallee Poussin kernel", phys.
/// stat. sol. (b) 200, 1997), proportional to cos^(2 kappa) of half the angle of rotation: the one whose plane normals have a
/// density in closed form too, so that a light can be connected to.
namespace opal {

/// kappa for a standard deviation of the tilt of `spread_rad` about each axis: near zero the density of a normal is
/// exp(-kappa theta^2 / 4).
OPAL_HD inline real mosaic_exponent(real spread_rad) {
    return 2.0f / (spread_rad * spread_rad);
}

/// Draws a tilt (a rotation) with four uniform numbers. In Hopf's coordinates of the unit quaternions, w = sqrt(s) cos(phi) and
/// z = sqrt(s) sin(phi), the density splits into s^kappa, inverted in closed form, and cos^(2 kappa) phi, whose tangent is
/// Student's t with 2 kappa + 1 degrees of freedom up to scale (Bailey, "Polar generation of random variates with the
/// t-distribution", Math. Comp. 62, 1994).
OPAL_HD inline Quaternion sample_mosaic_tilt(real kappa, real u1, real u2, real u3, real u4) {
    // 1 - s and the excess of Bailey's power, both free of cancellation where the spread is small.
    const real rest = -expm1(log(1.0f - u1) / (kappa + 1.0f));
    const real s = 1.0f - rest;
    const real tangent = sqrt(expm1(-2.0f * log(1.0f - u2) / (2.0f * kappa + 1.0f))) * cos(2.0f * pi_f * u3);
    const real cosine = 1.0f / sqrt(1.0f + tangent * tangent);
    const real azimuth_rad = 2.0f * pi_f * u4;
    const real radius = sqrt(max_of(0.0f, rest));
    return {radius * cos(azimuth_rad), radius * sin(azimuth_rad), sqrt(s) * cosine * tangent, sqrt(s) * cosine};
}

/// Density (1/sr) of a plane normal at `cosine` to its mean direction.
OPAL_HD inline real mosaic_normal_density(real kappa, real cosine) {
    return (kappa + 1.0f) / (4.0f * pi_f) * exp(kappa * log(max_of(1.0e-30f, 0.5f * (1.0f + cosine))));
}

/// Density (1/sr) of the direction into which planes with mean normal `normal` turn light that travels along `direction`, given
/// that they turn it: the half vector of the two directions is the tilted normal, and a mirrored direction moves 4 |w.g| times as
/// fast as the normal (in solid angle). Either sense of the normal counts.
OPAL_HD inline real mosaic_direction_density(real kappa, Vec3 normal, Vec3 direction, Vec3 turned) {
    const Vec3 half = normalize(turned - direction);
    const real cosine = dot(half, normal);
    const real density = mosaic_normal_density(kappa, cosine) + mosaic_normal_density(kappa, -cosine);
    return density / (4.0f * max_of(1.0e-12f, fabs(dot(direction, half))));
}

}  // namespace opal
