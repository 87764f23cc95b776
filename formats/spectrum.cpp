// SPDX-License-Identifier: Apache-2.0
#include "formats/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "formats/error.h"

namespace opal {

double SampledSpectrum::at(double wavelength) const {
    if (wavelength <= wavelength_nm.front()) return value.front();
    if (wavelength >= wavelength_nm.back()) return value.back();
    const std::size_t i = static_cast<std::size_t>(std::upper_bound(wavelength_nm.begin(), wavelength_nm.end(), wavelength) -
                                                   wavelength_nm.begin());
    const double t = (wavelength - wavelength_nm[i - 1]) / (wavelength_nm[i] - wavelength_nm[i - 1]);
    return value[i - 1] + t * (value[i] - value[i - 1]);
}

SampledSpectrum read_spectrum_csv(const std::filesystem::path& path) {
    std::ifstream stream(path);
    if (!stream) throw InputError(fmt::format("{}: no such file, or it cannot be read", path.string()));
    SampledSpectrum spectrum;
    std::string line;
    bool header_allowed = true;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        char* end = nullptr;
        const double wavelength = std::strtod(line.c_str(), &end);
        const bool first_is_number = end != line.c_str();
        while (*end == ' ' || *end == '\t' || *end == ',' || *end == ';') ++end;
        char* second_end = nullptr;
        const double value = std::strtod(end, &second_end);
        if (!first_is_number || second_end == end) {
            if (header_allowed) {
                header_allowed = false;
                continue;
            }
            throw InputError(fmt::format("{}:{}: expected 'wavelength_nm,value'", path.string(), number));
        }
        header_allowed = false;
        if (!std::isfinite(value) || value < 0.0)
            throw InputError(fmt::format("{}:{}: value {:g} is not allowed; at least 0", path.string(), number, value));
        if (!std::isfinite(wavelength) || (!spectrum.wavelength_nm.empty() && wavelength <= spectrum.wavelength_nm.back()))
            throw InputError(fmt::format("{}:{}: wavelengths must increase, in nm", path.string(), number));
        spectrum.wavelength_nm.push_back(wavelength);
        spectrum.value.push_back(value);
    }
    if (spectrum.value.size() < 2)
        throw InputError(fmt::format("{}: {} samples; at least 2 are needed", path.string(), spectrum.value.size()));
    return spectrum;
}

std::string spectrum_to_text(const SampledSpectrum& spectrum) {
    std::string text;
    for (std::size_t i = 0; i < spectrum.value.size(); ++i)
        text += fmt::format("{}{}:{}", i ? " " : "", spectrum.wavelength_nm[i], spectrum.value[i]);
    return text;
}

SampledSpectrum spectrum_from_text(const std::string& text) {
    SampledSpectrum spectrum;
    std::istringstream stream(text);
    double wavelength = 0.0, value = 0.0;
    char colon = 0;
    while (stream >> wavelength >> colon >> value) {
        const bool increases = spectrum.wavelength_nm.empty() || wavelength > spectrum.wavelength_nm.back();
        if (colon != ':' || !increases || !std::isfinite(value) || value < 0.0)
            throw InputError(fmt::format("spectrum text is broken near {} nm", wavelength));
        spectrum.wavelength_nm.push_back(wavelength);
        spectrum.value.push_back(value);
    }
    if (spectrum.value.empty() || !stream.eof()) throw InputError("spectrum text is broken or empty");
    return spectrum;
}

}  // namespace opal
