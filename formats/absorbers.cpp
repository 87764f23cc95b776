// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <math.h>  // pchip.hpp of Boost 1.74 calls isnan without naming its namespace

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>

#include "formats/error.h"
#include "formats/spectrum.h"
#include "formats/text.h"
#include "formats/units.h"

namespace opal {
namespace {

constexpr double smooth_step_nm = 10.0;
constexpr double absorber_step_nm = 5.0;
/// Fewer samples carry no cubic.
constexpr std::size_t min_cubic_samples = 4;
/// An absorber with less than this part of its strongest at the reference wavelength cannot be scaled by its value there.
constexpr double min_reference_part = 0.01;

/// strength exp(-((1/lambda - center) / width)^2 / 2).
struct Band {
    double center_per_cm;
    double width_per_cm;
    double strength;
};

/// fit_absorbers.py prints these; errors are in units of the largest value between 360 and 830 nm.
/// Hematite particles, small against the wavelength, thinly spread in silica: 0.18 % rms, 0.84 % at most off.
const std::vector<Band> iron_oxide_bands = {
    {11000.0, 6000.0, 0.0093}, {18264.0, 829.0, 0.0707}, {20208.0, 1335.0, 0.0575}, {27794.0, 4413.0, 1.0068}};
/// Methylene blue in ethanol: 0.33 % rms, 1.19 % at most off.
const std::vector<Band> light_blue_dye_bands = {{15180.0, 176.0, 0.2758},
                                                {15347.0, 388.0, 0.7101},
                                                {16366.0, 549.0, 0.3502},
                                                {17557.0, 599.0, 0.0644},
                                                {19512.0, 2560.0, 0.0232}};
/// Rhodamine B in ethanol, up to 700 nm: 0.42 % rms, 2.71 % at most off.
const std::vector<Band> pink_dye_bands = {{18256.0, 308.0, 0.1651},
                                          {18444.0, 438.0, 0.7682},
                                          {19493.0, 658.0, 0.3221},
                                          {21028.0, 555.0, 0.0395},
                                          {32000.0, 4722.0, 0.0868}};

template <typename Value>
SampledSpectrum sample(double step_nm, const Value& value) {
    SampledSpectrum spectrum;
    for (double wavelength = units::wavelength_min_nm; wavelength <= units::wavelength_max_nm; wavelength += step_nm) {
        spectrum.wavelength_nm.push_back(wavelength);
        spectrum.value.push_back(value(wavelength));
    }
    return spectrum;
}

SampledSpectrum sum_of_bands(const std::vector<Band>& bands) {
    const auto value = [&](double wavelength_nm) {
        double sum = 0.0;
        for (const Band& band : bands) {
            const double offset = (1.0e7 / wavelength_nm - band.center_per_cm) / band.width_per_cm;
            sum += band.strength * std::exp(-0.5 * offset * offset);
        }
        return sum;
    };
    const double at_550nm = value(550.0);
    return sample(absorber_step_nm, [&](double wavelength_nm) { return value(wavelength_nm) / at_550nm; });
}

}  // namespace

const std::vector<std::string>& builtin_absorbers() {
    static const std::vector<std::string> names = {"carbon", "neutral", "iron-oxide", "light-blue-dye", "pink-dye"};
    return names;
}

SampledSpectrum builtin_absorber(const std::string& name) {
    if (name == "carbon") return sample(smooth_step_nm, [](double wavelength_nm) { return 550.0 / wavelength_nm; });
    if (name == "neutral") return sample(smooth_step_nm, [](double) { return 1.0; });
    if (name == "iron-oxide") return sum_of_bands(iron_oxide_bands);
    if (name == "light-blue-dye") return sum_of_bands(light_blue_dye_bands);
    if (name == "pink-dye") return sum_of_bands(pink_dye_bands);
    throw InputError(fmt::format("absorber '{}' is not known; allowed: {}, or the path of a .csv file{}", name,
                                 join(builtin_absorbers()), did_you_mean(name, builtin_absorbers())));
}

SampledSpectrum resample_spectrum(const SampledSpectrum& spectrum) {
    if (spectrum.value.size() < min_cubic_samples)
        return sample(absorber_step_nm, [&](double wavelength_nm) { return spectrum.at(wavelength_nm); });
    std::vector<double> wavelength_nm = spectrum.wavelength_nm, value = spectrum.value;
    const boost::math::interpolators::pchip<std::vector<double>> cubic(std::move(wavelength_nm), std::move(value));
    return sample(absorber_step_nm, [&](double wanted_nm) {
        // Between samples the cubic is monotone; the clamp takes off what rounding leaves below zero.
        return std::max(0.0, cubic(std::clamp(wanted_nm, spectrum.wavelength_nm.front(), spectrum.wavelength_nm.back())));
    });
}

SampledSpectrum absorber_spectrum(const std::string& name_or_path, double value_at_reference, double reference_nm) {
    SampledSpectrum spectrum =
        name_or_path.ends_with(".csv") ? resample_spectrum(read_spectrum_csv(name_or_path)) : builtin_absorber(name_or_path);
    const double reference = spectrum.at(reference_nm);
    const auto strongest = std::max_element(spectrum.value.begin(), spectrum.value.end());
    if (value_at_reference > 0.0 && !(*strongest > 0.0))
        throw InputError(fmt::format("absorber '{}': is zero from 360 to 830 nm", name_or_path));
    if (value_at_reference > 0.0 && reference < min_reference_part * *strongest)
        throw InputError(
            fmt::format("absorber '{}': at {} nm it has {:.2g} % of its strongest, too little for sigma_a_per_mm to "
                        "scale it there; set sigma_a_reference_nm, e.g. to {} where it is strongest",
                        name_or_path, reference_nm, 100.0 * reference / *strongest,
                        spectrum.wavelength_nm[std::size_t(strongest - spectrum.value.begin())]));
    const double scale = value_at_reference > 0.0 ? value_at_reference / reference : 0.0;
    for (double& value : spectrum.value) value *= scale;
    return spectrum;
}

}  // namespace opal
