// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/plane_profile.h"

#include <algorithm>
#include <cmath>

#include "formats/units.h"

namespace opal {
namespace {

/// Distance of neighbouring planes of sphere centres: (222) shares those of (111).
double plane_distance_nm(const CrystalOptics& crystal, const PlaneFamily& planes) {
    return planes.order() / planes.g_per_nm(crystal);
}

/// Volume of the part of a ball that lies below height `z_nm` over its centre.
double ball_below_nm3(double radius_nm, double z_nm) {
    const double z = std::clamp(z_nm, -radius_nm, radius_nm);
    return units::pi * (radius_nm * radius_nm * (z + radius_nm) - (z * z * z + radius_nm * radius_nm * radius_nm) / 3.0);
}

}  // namespace

double plane_filling(const CrystalOptics& crystal, const PlaneFamily& planes, double low_nm, double high_nm) {
    const double distance_nm = plane_distance_nm(crystal, planes), radius_nm = 0.5 * crystal.sphere_diameter_nm;
    const double area_nm2 = 0.25 * std::pow(crystal.cell_edge_nm(), 3) / distance_nm;
    double spheres_nm3 = 0.0;
    const double first = std::ceil((low_nm - radius_nm) / distance_nm), last = std::floor((high_nm + radius_nm) / distance_nm);
    for (double plane = first; plane <= last; plane += 1.0)
        spheres_nm3 +=
            ball_below_nm3(radius_nm, high_nm - plane * distance_nm) - ball_below_nm3(radius_nm, low_nm - plane * distance_nm);
    return spheres_nm3 / (area_nm2 * (high_nm - low_nm));
}

std::vector<Film> plane_averaged_period(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm,
                                        int slices) {
    const double sphere = std::pow(crystal.n_sphere.at(wavelength_nm), 2),
                 medium = std::pow(crystal.n_medium.at(wavelength_nm), 2);
    const double distance_nm = plane_distance_nm(crystal, planes), thickness_nm = distance_nm / slices;
    std::vector<Film> films;
    films.reserve(static_cast<std::size_t>(slices));
    for (int slice = 0; slice < slices; ++slice) {
        const double low_nm = slice * thickness_nm - 0.5 * distance_nm;
        const double filling = plane_filling(crystal, planes, low_nm, low_nm + thickness_nm);
        films.push_back({thickness_nm, medium + (sphere - medium) * filling});
    }
    return films;
}

}  // namespace opal
