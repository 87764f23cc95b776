// SPDX-License-Identifier: Apache-2.0
#include "formats/metals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "formats/error.h"
#include "formats/text.h"

namespace opal {

/// A critical point of the bands.
struct CriticalPoint {
    double strength, phase_rad, place_nm, width_nm;
};

/// Permittivity of free electrons and two critical points: Etchegoin, Le Ru & Meyer, "An analytic model for the optical
/// properties of gold", J. Chem. Phys. 125, 2006, equations 1 and 2.
struct MetalFit {
    const char* name;
    double permittivity;  ///< far in the ultraviolet
    double plasma_nm, damping_nm;
    std::array<CriticalPoint, 2> points;
};

namespace {

/// fit_metals.py prints these. Largest error of the reflectance at normal incidence, 360 to 830 nm: gold 0.4 %, silver 0.4 %,
/// copper 0.7 %, platinum 0.02 %, rhodium 0.2 %, gold-silver 0.03 %; the measurements of the first three are themselves good to
/// about 1 %.
const std::array<MetalFit, 6> fits = {{
    {"gold", 0.97212, 142.01, 9283.6, {{{0.12839, -1.6324, 489.91, 6332.5}, {3.89, -1.576, 552.77, 1028.3}}}},
    {"silver", 5.9502, 125.63, 1.0e5, {{{0.032413, -1.4065, 348.93, 2767.2}, {0.17383, -1.5069, 802.31, 2614.7}}}},
    {"copper", 1.5943, 138.84, 18888, {{{50, -0.059804, 958.47, 229.55}, {0.55771, -1.8345, 588.7, 4884.2}}}},
    {"platinum", 1.5999, 138.06, 3210.1, {{{49.991, -0.30942, 1799.4, 1588.7}, {0.25834, 0.57592, 394.33, 924.13}}}},
    {"rhodium", 1.2016, 97.615, 2159, {{{23.301, -2.5883, 1507.9, 7806.7}, {1.0591, 0.81875, 416.74, 2043.5}}}},
    {"gold-silver", 2.5874, 137.2, 7305.1, {{{0.10601, -1.4653, 419.24, 3263.4}, {1.4962, -0.4417, 330.58, 939.04}}}},
}};

std::complex<double> permittivity(const MetalFit& fit, double wavelength_nm) {
    const std::complex<double> i(0.0, 1.0);
    const double x = 1.0 / wavelength_nm;
    std::complex<double> sum = fit.permittivity - 1.0 / (fit.plasma_nm * fit.plasma_nm * (x * x + i * x / fit.damping_nm));
    for (const CriticalPoint& point : fit.points) {
        const double place = 1.0 / point.place_nm, width = 1.0 / point.width_nm;
        const std::complex<double> turn = std::polar(1.0, point.phase_rad);
        sum += point.strength * place * (turn / (place - x - i * width) + std::conj(turn) / (place + x + i * width));
    }
    return sum;
}

}  // namespace

const std::vector<std::string>& metal_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const MetalFit& fit : fits) all.push_back(fit.name);
        return all;
    }();
    return names;
}

MetalIndex MetalIndex::of_metal(const std::string& name) {
    const auto found = std::find_if(fits.begin(), fits.end(), [&](const MetalFit& fit) { return name == fit.name; });
    if (found == fits.end())
        throw InputError(fmt::format("'{}' is not a known metal; allowed: {} or a .csv's path (wavelength_nm,n,k){}", name,
                                     join(metal_names()), did_you_mean(name, metal_names())));
    MetalIndex metal;
    metal.fit_ = &*found;
    return metal;
}

MetalIndex MetalIndex::from_csv(const std::filesystem::path& path) {
    std::ifstream stream(path);
    if (!stream) throw InputError(fmt::format("{}: no such file, or it cannot be read", path.string()));
    MetalIndex metal;
    std::string line;
    bool header_allowed = true;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        double value[3];
        const char* at = line.c_str();
        int count = 0;
        for (; count < 3; ++count) {
            char* end = nullptr;
            value[count] = std::strtod(at, &end);
            if (end == at) break;
            at = end + std::strspn(end, " \t,;");
        }
        if (count < 3) {
            if (!header_allowed) throw InputError(fmt::format("{}:{}: expected 'wavelength_nm,n,k'", path.string(), number));
            header_allowed = false;
            continue;
        }
        header_allowed = false;
        if (!(value[1] > 0.0 && value[1] <= 100.0) || !(value[2] >= 0.0 && value[2] <= 100.0))
            throw InputError(fmt::format("{}:{}: n {:g}, k {:g}; allowed: n above 0 and k from 0, to 100", path.string(), number,
                                         value[1], value[2]));
        if (!std::isfinite(value[0]) || (!metal.wavelength_nm_.empty() && value[0] <= metal.wavelength_nm_.back()))
            throw InputError(fmt::format("{}:{}: wavelengths must increase, in nm", path.string(), number));
        metal.wavelength_nm_.push_back(value[0]);
        metal.index_.push_back({value[1], value[2]});
    }
    if (metal.index_.size() < 2)
        throw InputError(fmt::format("{}: {} samples; at least 2 are needed", path.string(), metal.index_.size()));
    return metal;
}

MetalIndex MetalIndex::from_name(const std::string& name_or_path) {
    return name_or_path.ends_with(".csv") ? from_csv(name_or_path) : of_metal(name_or_path);
}

ComplexIndex MetalIndex::at(double wavelength_nm) const {
    if (fit_) {
        const std::complex<double> index = std::sqrt(permittivity(*fit_, wavelength_nm));
        return {index.real(), index.imag()};
    }
    if (wavelength_nm <= wavelength_nm_.front()) return index_.front();
    if (wavelength_nm >= wavelength_nm_.back()) return index_.back();
    const auto above =
        std::size_t(std::upper_bound(wavelength_nm_.begin(), wavelength_nm_.end(), wavelength_nm) - wavelength_nm_.begin());
    const double t = (wavelength_nm - wavelength_nm_[above - 1]) / (wavelength_nm_[above] - wavelength_nm_[above - 1]);
    return {index_[above - 1].n + t * (index_[above].n - index_[above - 1].n),
            index_[above - 1].k + t * (index_[above].k - index_[above - 1].k)};
}

double normal_reflectance(ComplexIndex index, double n_before) {
    const double k2 = index.k * index.k;
    return ((index.n - n_before) * (index.n - n_before) + k2) / ((index.n + n_before) * (index.n + n_before) + k2);
}

}  // namespace opal
