// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "formats/atomic_file.h"
#include "formats/colorimetry.h"
#include "formats/error.h"
#include "formats/illuminant.h"
#include "formats/text.h"
#include "formats/units.h"
#include "renderer/optics/crystal_flags.h"
#include "renderer/optics/csv_table.h"
#include "renderer/optics/optics_command.h"

namespace opal {
namespace {

struct ColorFlags {
    std::filesystem::path spectrum;
    std::string kind = "reflectance", illuminant, white = "D65";
    std::filesystem::path output;
};

/// "D65", "A", "E", "blackbody:3000", "led:4000" or a .csv.
SampledSpectrum parse_illuminant(const std::string& flag, const std::string& text) {
    if (text.ends_with(".csv")) return illuminant_spectrum(IlluminantKind::file, 0.0, text);
    if (text == "D65") return illuminant_spectrum(IlluminantKind::d65);
    if (text == "A") return illuminant_spectrum(IlluminantKind::a);
    if (text == "E") return illuminant_spectrum(IlluminantKind::equal_energy);
    const std::string kind = text.substr(0, text.find(':'));
    const bool has_temperature = kind.size() < text.size();
    if (has_temperature && kind == "blackbody")
        return illuminant_spectrum(IlluminantKind::blackbody, single_value(flag, text.substr(kind.size() + 1), 500.0, 1.0e6));
    if (has_temperature && kind == "led")
        return illuminant_spectrum(IlluminantKind::led, single_value(flag, text.substr(kind.size() + 1), led_min_k, led_max_k));
    throw InputError(
        fmt::format("{} {}: not known; allowed: D65, A, E, blackbody:K, led:K (K in kelvin) or a .csv's path", flag, text));
}

std::string srgb_hex(Rgb3d linear) {
    const auto byte = [](double component) { return int(std::lround(255.0 * srgb_encoded(std::clamp(component, 0.0, 1.0)))); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(linear.r), byte(linear.g), byte(linear.b));
}

void run_color(const ColorFlags& flags) {
    const bool emits = flags.kind == "emission";
    if (emits && !flags.illuminant.empty()) throw InputError("--illuminant: goes with --kind reflectance only");
    const SampledSpectrum white = parse_illuminant("--white", flags.white);
    const SampledSpectrum light = parse_illuminant("--illuminant", flags.illuminant.empty() ? "D65" : flags.illuminant);
    const SampledSpectrum spectrum = read_spectrum_csv(flags.spectrum);
    if (!flags.output.empty()) require_writable(flags.output);
    if (spectrum.wavelength_nm.front() > units::wavelength_min_nm || spectrum.wavelength_nm.back() < units::wavelength_max_nm)
        fmt::print(stderr, "opal-optics: note: {} covers {:.6g} to {:.6g} nm; beyond, its end values are taken\n",
                   flags.spectrum.string(), spectrum.wavelength_nm.front(), spectrum.wavelength_nm.back());
    const Xyz color = emits ? xyz_of(spectrum) : xyz_of(spectrum, light);
    const Rgb3d linear = linear_srgb_from_xyz(bradford_adaptation(xyz_of(white), srgb_white) * color);
    const Chromaticity chromaticity = color.y > 0.0 ? chromaticity_of(color) : Chromaticity{0.0, 0.0};
    CsvTable table("X,Y,Z,x,y,r_linear,g_linear,b_linear,srgb_hex");
    table.add_row({color.x, color.y, color.z, chromaticity.x, chromaticity.y, linear.r, linear.g, linear.b}, srgb_hex(linear));
    write_csv(table, flags.output);
}

}  // namespace

OpticsAction add_color(CLI::App& app) {
    const auto flags = std::make_shared<ColorFlags>();
    CLI::App& command = *app.add_subcommand("color", "Colour of a spectrum");
    command.footer(
        "Columns X,Y,Z,x,y,r_linear,g_linear,b_linear,srgb_hex: CIE 1931 2 degrees; Y of a reflectance 1 is 1, of an emission 1 "
        "at\n"
        "every wavelength likewise. sRGB after adaptation (linear Bradford) of the white to D65; linear components are not cut, "
        "the\n"
        "8-bit ones are.");
    command.add_option("SPECTRUM", flags->spectrum, "table wavelength_nm,value (.csv)")->required();
    command.add_option("--kind", flags->kind, "reflectance, seen under a light, or emission")
        ->check(CLI::IsMember({"reflectance", "emission"}))
        ->capture_default_str();
    command.add_option("--illuminant", flags->illuminant, "D65 (default), A, E, blackbody:K, led:K or a .csv")
        ->type_name("LIGHT");
    command.add_option("--white", flags->white, "light that is shown as white, likewise")
        ->capture_default_str()
        ->type_name("LIGHT");
    command.add_option("-o,--output", flags->output, "file to write instead of standard output")->type_name("OUT.csv");
    return [flags] { run_color(*flags); };
}

}  // namespace opal
