// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/units.h"
#include "renderer/optics/crystal_flags.h"
#include "renderer/optics/csv_table.h"
#include "renderer/optics/optics_command.h"
#include "renderer/optics/reflectance.h"
#include "renderer/optics/value_list.h"

namespace opal {
namespace {

struct ReflectanceFlags {
    CrystalFlags crystal;
    std::string layers, thickness_um, blocks = "1", angle_deg = "0", wavelength_nm = "400:700:1";
    std::string angle_in = "outside", polarization = "both", model = "two-beam", tolerance, slices, ambient = "mean";
    std::filesystem::path output;
};

void add_slab_flags(CLI::App& command, ReflectanceFlags& flags) {
    command.add_option("--layers", flags.layers, "thickness of the slab in distances of two planes, 1/|G|")->type_name("N");
    command.add_option("--thickness-um", flags.thickness_um, "or its thickness, um")->type_name("UM");
    command.add_option("--blocks", flags.blocks, "slabs one behind the other, without interference between them")
        ->capture_default_str()
        ->type_name("M");
    command.add_option("--model", flags.model, "two-beam, ewald-fresnel, laue or transfer-matrix")
        ->check(CLI::IsMember({"two-beam", "ewald-fresnel", "laue", "transfer-matrix"}))
        ->capture_default_str();
    command
        .add_option("--tolerance", flags.tolerance,
                    "ewald-fresnel: largest deviation of |w + (lambda/n) G| from 1 (default 0.01)")
        ->type_name("T");
    command.add_option("--slices", flags.slices, "transfer-matrix: films per distance of two planes of centres (default 1024)")
        ->type_name("N");
    command
        .add_option("--ambient", flags.ambient,
                    "transfer-matrix: around the slab the mean index, or the medium and whole spheres")
        ->check(CLI::IsMember({"mean", "medium"}))
        ->capture_default_str();
}

ReflectanceSetup make_setup(const ReflectanceFlags& flags) {
    ReflectanceSetup setup;
    const double diameter_nm = single_value("--sphere-diameter-nm", flags.crystal.sphere_diameter_nm, 10.0, 1.0e4);
    setup.crystal = parse_crystal(flags.crystal, diameter_nm);
    setup.planes = parse_planes(flags.crystal);
    setup.blocks = single_value("--blocks", flags.blocks, 1.0, 1.0e6);
    if (flags.model == "ewald-fresnel") setup.model = ReflectanceModel::ewald_fresnel;
    if (flags.model == "laue") setup.model = ReflectanceModel::laue;
    if (flags.model == "transfer-matrix") setup.model = ReflectanceModel::transfer_matrix;
    if (!flags.tolerance.empty() && setup.model != ReflectanceModel::ewald_fresnel)
        throw InputError("--tolerance: goes with --model ewald-fresnel only");
    if (!flags.slices.empty() && setup.model != ReflectanceModel::transfer_matrix)
        throw InputError("--slices: goes with --model transfer-matrix only");
    if (flags.ambient == "medium") setup.ambient = Ambient::medium;
    if (setup.ambient == Ambient::medium && setup.model != ReflectanceModel::transfer_matrix)
        throw InputError("--ambient medium: goes with --model transfer-matrix only");
    if (!flags.tolerance.empty()) setup.ewald_tolerance = single_value("--tolerance", flags.tolerance, 1.0e-9, 0.5);
    if (!flags.slices.empty()) setup.slices_per_period = int(single_value("--slices", flags.slices, 1.0, 1.0e5));
    if (!flags.layers.empty() && !flags.thickness_um.empty())
        throw InputError("--layers and --thickness-um: one thickness is enough");
    if (!flags.layers.empty()) {
        setup.layers = single_value("--layers", flags.layers, 1.0, 1.0e6);
    } else if (!flags.thickness_um.empty()) {
        setup.layers = single_value("--thickness-um", flags.thickness_um, 1.0e-3, 1.0e6) * units::nm_per_um *
                       setup.planes.g_per_nm(setup.crystal);
    } else if (setup.model != ReflectanceModel::ewald_fresnel) {
        throw InputError(fmt::format("--model {}: needs a thickness, --layers or --thickness-um", flags.model));
    }
    const double planes_of_centres = setup.layers / setup.planes.order();
    if (setup.ambient == Ambient::medium && planes_of_centres != std::floor(planes_of_centres))
        throw InputError(fmt::format("--ambient medium: whole spheres make whole planes; --layers must be a multiple of {}",
                                     setup.planes.order()));
    return setup;
}

double cosine_inside(const ReflectanceSetup& setup, double wavelength_nm, double angle_deg, bool outside) {
    const double sine = std::sin(units::rad_from_deg(angle_deg)) / (outside ? direction_index(setup, wavelength_nm) : 1.0);
    return std::sqrt(1.0 - sine * sine);
}

void run_reflectance(const ReflectanceFlags& flags) {
    const ReflectanceSetup setup = make_setup(flags);
    const std::vector<double> angles_deg = parse_values("--angle-deg", flags.angle_deg, 0.0, flag_angle_max_deg);
    const std::vector<double> wavelengths_nm =
        parse_wavelengths_nm(flags.wavelength_nm, setup.crystal.n_sphere, setup.crystal.n_medium);
    if (!flags.output.empty()) require_writable(flags.output);
    const std::string header = "wavelength_nm,reflectance_s,reflectance_p,reflectance";
    CsvTable table(angles_deg.size() > 1 ? "angle_deg," + header : header);
    const double weight_s = flags.polarization == "s" ? 1.0 : (flags.polarization == "p" ? 0.0 : 0.5);
    for (const double angle_deg : angles_deg)
        for (const double wavelength_nm : wavelengths_nm) {
            const double cosine = cosine_inside(setup, wavelength_nm, angle_deg, flags.angle_in == "outside");
            const PolarizedReflectance<double> r = reflectance_at(setup, wavelength_nm, cosine);
            std::vector<double> row = {wavelength_nm, r.s, r.p, weight_s * r.s + (1.0 - weight_s) * r.p};
            if (angles_deg.size() > 1) row.insert(row.begin(), angle_deg);
            table.add_row(row);
        }
    write_csv(table, flags.output);
}

}  // namespace

OpticsAction add_reflectance(CLI::App& app) {
    const auto flags = std::make_shared<ReflectanceFlags>();
    CLI::App& command = *app.add_subcommand("reflectance", "Reflectance of a slab of crystal planes over the wavelength");
    command.footer(
        "Columns wavelength_nm,reflectance_s,reflectance_p,reflectance; before them angle_deg where there are several angles.\n"
        "The slab lies in a medium of its own mean index: its faces reflect nothing. Angles outside are in air in front of a\n"
        "surface parallel to the planes; refraction is by the effective index, for transfer-matrix by that of the ambient, the\n"
        "root of the mean n^2 or the medium's.");
    add_crystal_flags(command, flags->crystal);
    add_slab_flags(command, *flags);
    command.add_option("--angle-deg", flags->angle_deg, "angle to the planes' normal, degrees")
        ->capture_default_str()
        ->type_name("VALUES");
    command.add_option("--angle-in", flags->angle_in, "where that angle is meant: outside, in air, or inside the crystal")
        ->check(CLI::IsMember({"outside", "inside"}))
        ->capture_default_str();
    command.add_option("--wavelength-nm", flags->wavelength_nm, "vacuum wavelengths, nm")
        ->capture_default_str()
        ->type_name("VALUES");
    command.add_option("--polarization", flags->polarization, "what the last column holds: s, p, or both: their mean")
        ->check(CLI::IsMember({"s", "p", "both"}))
        ->capture_default_str();
    command.add_option("-o,--output", flags->output, "file to write instead of standard output")->type_name("OUT.csv");
    return [flags] { run_reflectance(*flags); };
}

}  // namespace opal
