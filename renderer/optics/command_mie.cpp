// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <memory>

#include "formats/atomic_file.h"
#include "formats/lorenz_mie.h"
#include "formats/units.h"
#include "renderer/optics/crystal_flags.h"
#include "renderer/optics/csv_table.h"
#include "renderer/optics/optics_command.h"
#include "renderer/optics/value_list.h"

namespace opal {
namespace {

struct MieFlags {
    CrystalFlags sphere;
    std::string wavelength_nm = "400:700:10", phase;
    std::filesystem::path output;
};

void run_mie(const MieFlags& flags) {
    const double diameter_nm = single_value("--sphere-diameter-nm", flags.sphere.sphere_diameter_nm, 1.0, 1.0e5);
    const RefractiveIndex n_sphere = parse_index("--n-sphere", flags.sphere.n_sphere);
    const RefractiveIndex n_medium = parse_index("--n-medium", flags.sphere.n_medium);
    const std::vector<double> wavelengths_nm = parse_wavelengths_nm(flags.wavelength_nm, n_sphere, n_medium);
    std::vector<double> angles_deg;
    if (!flags.phase.empty()) angles_deg = parse_values("--phase", flags.phase, 0.0, 180.0);
    if (!flags.output.empty()) require_writable(flags.output);

    CsvTable table(flags.phase.empty() ? "wavelength_nm,size_parameter,q_sca,q_ext,g" : "wavelength_nm,angle_deg,phase_per_sr");
    for (const double wavelength_nm : wavelengths_nm) {
        const double medium = n_medium.at(wavelength_nm);
        const MieCoefficients coefficients =
            mie_coefficients(units::pi * diameter_nm * medium / wavelength_nm, n_sphere.at(wavelength_nm) / medium);
        const MieEfficiencies result = mie_efficiencies(coefficients);
        if (flags.phase.empty())
            table.add_row({wavelength_nm, coefficients.size_parameter, result.q_sca, result.q_ext, result.asymmetry});
        for (const double angle_deg : angles_deg)
            table.add_row({wavelength_nm, angle_deg,
                           mie_phase_function(coefficients, result.q_sca, std::cos(units::rad_from_deg(angle_deg)))});
    }
    write_csv(table, flags.output);
}

}  // namespace

OpticsAction add_mie(CLI::App& app) {
    const auto flags = std::make_shared<MieFlags>();
    CLI::App& command = *app.add_subcommand("mie", "Lorenz-Mie scattering of one sphere in a medium");
    command.footer(
        "Columns wavelength_nm,size_parameter,q_sca,q_ext,g: size parameter pi diameter n_medium / wavelength, efficiencies "
        "over\n"
        "the geometric cross-section, mean cosine. With --phase instead wavelength_nm,angle_deg,phase_per_sr, unpolarized, "
        "whose\n"
        "integral over the sphere is 1.");
    add_sphere_flags(command, flags->sphere);
    command.add_option("--wavelength-nm", flags->wavelength_nm, "vacuum wavelengths, nm")
        ->capture_default_str()
        ->type_name("VALUES");
    command.add_option("--phase", flags->phase, "the phase function at these scattering angles, degrees")->type_name("VALUES");
    command.add_option("-o,--output", flags->output, "file to write instead of standard output")->type_name("OUT.csv");
    return [flags] { run_mie(*flags); };
}

}  // namespace opal
