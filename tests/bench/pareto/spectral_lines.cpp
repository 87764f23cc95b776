// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectral_lines.h"

#include <algorithm>

#include "renderer/host/film.h"

namespace opal {
namespace {

constexpr int range_nm = spectrum_samples - 1;

/// Where a display's red, green and blue are strongest, about.
constexpr int rgb_lines_nm[3] = {610, 550, 465};

}  // namespace

SpectralLines::SpectralLines(const SpectrumTables& tables, SpectralChoice choice) : choice_(choice) {
    if (choice == SpectralChoice::continuous) return;
    line_of_nm_.assign(std::size_t(range_nm), -1);
    if (choice == SpectralChoice::rgb) {
        for (int c = 0; c < 3; ++c) {
            const double white = double(table_at(tables.white, float(rgb_lines_nm[c])));
            const Xyz color = xyz_from_linear_srgb({c == 0 ? 1.0 : 0.0, c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0});
            add_line(rgb_lines_nm[c], {color.x / white, color.y / white, color.z / white});
        }
    } else {
        for (int bin = 0; bin < num_bins; ++bin) {
            const int centre_nm = int(bin_centre_nm(bin));
            Xyz sum{0.0, 0.0, 0.0};
            for (int tenth = 0; tenth < 100; ++tenth) {
                const float wavelength_nm = float(centre_nm) - 4.95f + 0.1f * float(tenth);
                if (wavelength_nm < spectrum_min_nm || wavelength_nm > spectrum_max_nm) continue;
                const Vec3 observer = table_at(tables.observer, wavelength_nm);
                sum = {sum.x + 0.1 * double(observer.x), sum.y + 0.1 * double(observer.y), sum.z + 0.1 * double(observer.z)};
            }
            add_line(centre_nm, sum);
        }
    }
    pdf_.assign(std::size_t(spectrum_samples), 0.0f);
    cdf_.assign(std::size_t(spectrum_samples), 1.0f);
    double integral = 0.0;
    for (int nm = 0; nm < range_nm; ++nm) {
        cdf_[std::size_t(nm)] = float(integral);
        const int line = line_of_nm_[std::size_t(nm)];
        if (line < 0) continue;
        pdf_[std::size_t(nm)] = 1.0f / float(lines_.size()) / float(lines_[std::size_t(line)].width_nm);
        integral += 1.0 / double(lines_.size()) / lines_[std::size_t(line)].width_nm;
    }
}

void SpectralLines::add_line(int centre_nm, Xyz color) {
    const int centre = centre_nm - int(spectrum_min_nm);
    const int first = std::max(0, centre - 1), end = std::min(range_nm, centre + 1);
    for (int nm = first; nm < end; ++nm) line_of_nm_[std::size_t(nm)] = int(lines_.size());
    lines_.push_back({first, end - first, color});
}

void SpectralLines::confine(SpectrumTables& tables) const {
    if (choice_ == SpectralChoice::continuous) return;
    tables.pdf = pdf_.data();
    tables.cdf = cdf_.data();
    tables.alias = {};
}

Xyz SpectralLines::color(const SpectrumTables& tables, real wavelength_nm, real pdf_per_nm) const {
    if (choice_ == SpectralChoice::continuous) {
        const Vec3 observer = table_at(tables.observer, wavelength_nm);
        const double scale = 1.0 / double(pdf_per_nm);
        return {double(observer.x) * scale, double(observer.y) * scale, double(observer.z) * scale};
    }
    const auto line_at = [this](int nm) { return line_of_nm_[std::size_t(std::clamp(nm, 0, range_nm - 1))]; };
    const int nm = int(wavelength_nm - spectrum_min_nm);
    int line = line_at(nm);
    // A wavelength just below a whole number may have been rounded to it.
    if (line < 0 && real(nm) == wavelength_nm - spectrum_min_nm) line = line_at(nm - 1);
    if (line < 0) return {0.0, 0.0, 0.0};
    const Xyz& color = lines_[std::size_t(line)].color;
    const double lines = double(lines_.size());
    return {color.x * lines, color.y * lines, color.z * lines};
}

}  // namespace opal
