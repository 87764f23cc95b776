// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/units.h"
#include "renderer/optics/bragg_chart.h"
#include "renderer/optics/crystal_flags.h"
#include "renderer/optics/csv_table.h"
#include "renderer/optics/optics_command.h"
#include "renderer/optics/value_list.h"

namespace opal {
namespace {

struct BraggFlags {
    CrystalFlags crystal;
    std::string angle_deg = "0:60:5";
    std::filesystem::path output, chart;
};

void write_chart(const BraggFlags& flags, const std::vector<double>& diameters_nm, const std::vector<double>& angles_deg) {
    const auto [low_nm, high_nm] = std::minmax_element(diameters_nm.begin(), diameters_nm.end());
    const auto [low_deg, high_deg] = std::minmax_element(angles_deg.begin(), angles_deg.end());
    write_png(flags.chart, draw_bragg_chart({parse_crystal(flags.crystal, *low_nm), parse_planes(flags.crystal), *low_nm,
                                             *high_nm, *low_deg, *high_deg,
                                             fmt::format("Bragg colour of ({}), spheres {} in {}", flags.crystal.hkl,
                                                         flags.crystal.n_sphere, flags.crystal.n_medium)}));
}

void run_bragg(const BraggFlags& flags) {
    const std::vector<double> diameters_nm = parse_diameters_nm(flags.crystal);
    const std::vector<double> angles_deg = parse_values("--angle-deg", flags.angle_deg, 0.0, flag_angle_max_deg);
    const PlaneFamily planes = parse_planes(flags.crystal);
    if (!flags.chart.empty()) {
        if (flags.chart.extension() != ".png")
            throw InputError(fmt::format("--chart {}: the name must end in .png", flags.chart.string()));
        if (diameters_nm.size() < 2 || angles_deg.size() < 2)
            throw InputError("--chart: needs ranges in both --sphere-diameter-nm and --angle-deg, which become its axes");
        require_writable(flags.chart);
    }
    if (!flags.output.empty()) require_writable(flags.output);
    const std::string header = "angle_deg,wavelength_nm,relative_width";
    CsvTable table(diameters_nm.size() > 1 ? "sphere_diameter_nm," + header : header);
    CrystalOptics crystal = parse_crystal(flags.crystal, diameters_nm.front());
    for (const double diameter_nm : diameters_nm) {
        crystal.sphere_diameter_nm = diameter_nm;
        for (const double angle_deg : angles_deg) {
            const double wavelength_nm = bragg_wavelength_outside_nm(crystal, planes, units::rad_from_deg(angle_deg));
            const double sine = std::sin(units::rad_from_deg(angle_deg)) / crystal.effective_index(wavelength_nm);
            const double width = relative_band_width(crystal, planes, wavelength_nm, std::sqrt(1.0 - sine * sine));
            std::vector<double> row = {angle_deg, wavelength_nm, width};
            if (diameters_nm.size() > 1) row.insert(row.begin(), diameter_nm);
            table.add_row(row);
        }
    }
    if (!flags.chart.empty()) write_chart(flags, diameters_nm, angles_deg);
    write_csv(table, flags.output);
}

}  // namespace

OpticsAction add_bragg(CLI::App& app) {
    const auto flags = std::make_shared<BraggFlags>();
    CLI::App& command = *app.add_subcommand("bragg", "Bragg peaks over angle and sphere diameter, and their colours as a chart");
    command.footer(
        "Columns angle_deg,wavelength_nm,relative_width; before them sphere_diameter_nm where there are several diameters.\n"
        "The angle is in air in front of a surface parallel to the planes, refraction included: wavelength = 2 sqrt(n_eff^2 -\n"
        "sin^2) / |G|. relative_width is that of the stop band for s polarization, |eps_G| / (mean permittivity cos^2) with the\n"
        "angle inside. --sphere-diameter-nm takes VALUES.");
    add_crystal_flags(command, flags->crystal);
    command.add_option("--angle-deg", flags->angle_deg, "angles outside, in air, degrees")
        ->capture_default_str()
        ->type_name("VALUES");
    command.add_option("--chart", flags->chart, "draw diameter across, angle up, each point the colour of its Bragg wavelength")
        ->type_name("OUT.png");
    command.add_option("-o,--output", flags->output, "file to write instead of standard output")->type_name("OUT.csv");
    return [flags] { run_bragg(*flags); };
}

}  // namespace opal
