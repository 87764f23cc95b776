// SPDX-License-Identifier: Apache-2.0
#include "renderer/optics/optics_command.h"

#include <fmt/format.h>

#include "formats/error.h"
#include "formats_generated/version.h"

namespace opal {
namespace {

constexpr const char* footer =
    R"(Wavelengths are vacuum nm, sphere diameters nm, thicknesses um, angles degrees. VALUES is one number, a list a,b,c or
a range first:last:step. The table goes to standard output, or with -o to a file. opal-optics COMMAND --help says more.

Examples:
  opal-optics reflectance --sphere-diameter-nm 250 --n-sphere 1.45 --n-medium 1.333 --hkl 1,1,1 --layers 24 \
      --angle-deg 0 --wavelength-nm 520:640:0.5 --model two-beam
  opal-optics bragg --sphere-diameter-nm 150:350:5 --angle-deg 0:60:5 --chart colors.png -o colors.csv
  opal-optics mie --sphere-diameter-nm 250 --n-sphere silica --n-medium water --wavelength-nm 400:700:50
  opal-optics color spectrum.csv --kind reflectance --illuminant A)";

}  // namespace

int optics_command(int argc, char** argv) {
    CLI::App app("opal-optics: the optics of opal alone, as tables: reflectance, Bragg peaks, scattering, colour");
    app.footer(footer);
    app.set_version_flag("--version", std::string("opal-optics ") + OPAL_VERSION_STRING);
    app.require_subcommand(1);
    OpticsAction chosen;
    for (const auto& add : {add_reflectance, add_bragg, add_mie, add_color}) {
        const OpticsAction action = add(app);
        app.get_subcommands([](CLI::App*) { return true; }).back()->callback([&chosen, action] { chosen = action; });
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("{} (opal-optics --help shows the options)", error.what()));
    }
    chosen();
    return 0;
}

}  // namespace opal
