// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_spectra.h"

#include "cell_samples.h"
#include "formats/colorimetry.h"
#include "renderer/host/film.h"
#include "renderer/host/spectrum_tables.h"

namespace opal {
namespace {

struct Band {
    double low_nm, high_nm;

    bool holds(double wavelength_nm) const { return wavelength_nm >= low_nm && wavelength_nm < high_nm; }
};

void add_response(const SpectrumTables& tables, double wavelength_nm, double weight_nm, Xyz& sum) {
    const Vec3 observer = table_at(tables.observer, float(wavelength_nm));
    const double light = weight_nm * double(table_at(tables.white, float(wavelength_nm)));
    sum = {sum.x + light * double(observer.x), sum.y + light * double(observer.y), sum.z + light * double(observer.z)};
}

/// Integral over an interval, in steps of a four-thousandth of it.
Xyz response_of(const SpectrumTables& tables, double low_nm, double high_nm) {
    Xyz sum{0.0, 0.0, 0.0};
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i)
        add_response(tables, low_nm + (high_nm - low_nm) * (i + 0.5) / steps, (high_nm - low_nm) / steps, sum);
    return sum;
}

/// Each layer as the mean of the band over it, and its wavelengths' mean response.
Xyz by_layers(const SpectrumTables& tables, const Band& band) {
    Xyz sum{0.0, 0.0, 0.0};
    for (int bin = 0; bin < num_bins; ++bin) {
        const double low = std::max(360.0, bin_centre_nm(bin) - 5.0), high = std::min(830.0, bin_centre_nm(bin) + 5.0);
        const double share = std::max(0.0, std::min(high, band.high_nm) - std::max(low, band.low_nm)) / (high - low);
        if (share == 0.0) continue;
        const Xyz layer = response_of(tables, low, high);
        sum = {sum.x + share * layer.x, sum.y + share * layer.y, sum.z + share * layer.z};
    }
    return sum;
}

Xyz by_fixed_wavelengths(const SpectrumTables& tables, const Band& band) {
    Xyz sum{0.0, 0.0, 0.0};
    for (int bin = 0; bin < num_bins; ++bin)
        if (band.holds(bin_centre_nm(bin))) add_response(tables, bin_centre_nm(bin), 10.0, sum);
    return sum;
}

Xyz by_drawn_wavelengths(const SpectrumTables& tables, const Band& band, int count, cell_samples::Draws& draws) {
    Xyz sum{0.0, 0.0, 0.0};
    for (int n = 0; n < count; n += 4) {
        const PathWavelengths<4> drawn = sample_wavelengths<4>(tables, float(draws.next()), 4);
        for (int lane = 0; lane < 4; ++lane)
            if (band.holds(double(drawn.wavelength_nm[lane])))
                add_response(tables, double(drawn.wavelength_nm[lane]), 1.0 / (double(drawn.pdf_per_nm[lane]) * count), sum);
    }
    return sum;
}

Lab shown(Xyz color, double scale) {
    return lab_from_xyz({scale * color.x, scale * color.y, scale * color.z}, srgb_white);
}

}  // namespace

const char* name_of(WavelengthChoice choice) {
    switch (choice) {
        case WavelengthChoice::fixed_48:
            return "48 fixed wavelengths";
        case WavelengthChoice::layers_48:
            return "colour from 48 layers of 10 nm";
        case WavelengthChoice::continuous:
            break;
    }
    return "continuous wavelengths";
}

BandError band_error(WavelengthChoice choice, double width_nm, int places, int wavelengths) {
    const SpectrumTablesData data = make_spectrum_tables();
    const SpectrumTables tables = data.view();
    cell_samples::Draws draws(10);
    SampleMean energy, squares, color;
    for (int place = 0; place < places; ++place) {
        const double low_nm = 440.0 + (220.0 - width_nm) * (place + draws.next()) / places;
        const Band band{low_nm, low_nm + width_nm};
        const Xyz right = response_of(tables, band.low_nm, band.high_nm);
        const Xyz found = choice == WavelengthChoice::fixed_48    ? by_fixed_wavelengths(tables, band)
                          : choice == WavelengthChoice::layers_48 ? by_layers(tables, band)
                                                                  : by_drawn_wavelengths(tables, band, wavelengths, draws);
        const double error = found.y / right.y - 1.0;
        energy.add(error);
        squares.add(error * error);
        color.add(delta_e_2000(shown(right, 0.5 / right.y), shown(found, 0.5 / right.y)));
    }
    return {std::sqrt(squares.estimate().mean), energy.estimate(), color.estimate()};
}

void add_spectrum_rows(bool quick, StabilityRows& rows) {
    const int places = quick ? 100 : 400, wavelengths = 100'000;
    for (const WavelengthChoice choice :
         {WavelengthChoice::fixed_48, WavelengthChoice::layers_48, WavelengthChoice::continuous}) {
        const bool continuous = choice == WavelengthChoice::continuous, layers = choice == WavelengthChoice::layers_48;
        const std::string outcome = continuous ? "what the renderer does: right in the mean, noise alone"
                                    : layers ? "film.spectral stores layers of means; the picture's colour is not made from them"
                                             : "not offered",
                          test = continuous
                                     ? "Stability.NarrowBandsNeedContinuousWavelengths; SpectralLayers.IntegrateToTheColour"
                                     : "Stability.NarrowBandsNeedContinuousWavelengths";
        for (const double width_nm : {0.1, 0.3, 1.0, 2.0, 5.0, 8.0, 10.0, 15.0, 20.0}) {
            const BandError error = band_error(choice, width_nm, places, wavelengths);
            const auto add = [&](Estimate value, const std::string& unit) {
                rows.push_back({"narrow bands", name_of(choice), "width of the band (nm)", width_nm, value, unit, outcome, test});
            };
            add({error.energy_rms, error.energy_mean.standard_error}, "relative error of the luminance, rms over places");
            add({std::abs(error.energy_mean.mean), error.energy_mean.standard_error}, "relative error of the luminance, mean");
            add(error.delta_e, "CIEDE2000");
        }
    }
}

}  // namespace opal
