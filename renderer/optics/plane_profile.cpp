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

/// plane_filling of the planes of centres number `first` to `last`; number 0 lies at height 0.
double filling_of_planes(const CrystalOptics& crystal, const PlaneFamily& planes, double low_nm, double high_nm, double first,
                         double last) {
    const double distance_nm = plane_distance_nm(crystal, planes), radius_nm = 0.5 * crystal.sphere_diameter_nm;
    const double area_nm2 = 0.25 * std::pow(crystal.cell_edge_nm(), 3) / distance_nm;
    double spheres_nm3 = 0.0;
    first = std::max(first, std::ceil((low_nm - radius_nm) / distance_nm));
    last = std::min(last, std::floor((high_nm + radius_nm) / distance_nm));
    for (double plane = first; plane <= last; plane += 1.0)
        spheres_nm3 +=
            ball_below_nm3(radius_nm, high_nm - plane * distance_nm) - ball_below_nm3(radius_nm, low_nm - plane * distance_nm);
    return spheres_nm3 / (area_nm2 * (high_nm - low_nm));
}

/// Permittivity of the medium where nothing is filled, of the spheres where all is.
double mixed_permittivity(const CrystalOptics& crystal, double wavelength_nm, double filling) {
    const double sphere = std::pow(crystal.n_sphere.at(wavelength_nm), 2),
                 medium = std::pow(crystal.n_medium.at(wavelength_nm), 2);
    return medium + (sphere - medium) * filling;
}

}  // namespace

double plane_filling(const CrystalOptics& crystal, const PlaneFamily& planes, double low_nm, double high_nm) {
    return filling_of_planes(crystal, planes, low_nm, high_nm, -HUGE_VAL, HUGE_VAL);
}

std::vector<Film> plane_averaged_slab(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm, long count,
                                      int slices) {
    const double distance_nm = plane_distance_nm(crystal, planes);
    const double depth_nm = double(count - 1) * distance_nm + crystal.sphere_diameter_nm;
    const auto num_films = static_cast<std::size_t>(std::ceil(depth_nm * slices / distance_nm));
    const double thickness_nm = depth_nm / double(num_films);
    std::vector<Film> films;
    films.reserve(num_films);
    for (std::size_t n = 0; n < num_films; ++n) {
        const double low_nm = double(n) * thickness_nm - 0.5 * crystal.sphere_diameter_nm;
        const double filling = filling_of_planes(crystal, planes, low_nm, low_nm + thickness_nm, 0.0, double(count - 1));
        films.push_back({thickness_nm, mixed_permittivity(crystal, wavelength_nm, filling)});
    }
    return films;
}

std::vector<Film> plane_averaged_period(const CrystalOptics& crystal, const PlaneFamily& planes, double wavelength_nm,
                                        int slices) {
    const double distance_nm = plane_distance_nm(crystal, planes), thickness_nm = distance_nm / slices;
    std::vector<Film> films;
    films.reserve(static_cast<std::size_t>(slices));
    for (int slice = 0; slice < slices; ++slice) {
        const double low_nm = slice * thickness_nm - 0.5 * distance_nm;
        const double filling = plane_filling(crystal, planes, low_nm, low_nm + thickness_nm);
        films.push_back({thickness_nm, mixed_permittivity(crystal, wavelength_nm, filling)});
    }
    return films;
}

}  // namespace opal
