// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace opal {

/// The command line of opal-optics: parses, computes, writes. Returns the exit code; throws InputError and SystemError.
int optics_command(int argc, char** argv);

/// What the chosen subcommand does once its flags are parsed.
using OpticsAction = std::function<void()>;

/// One subcommand each: adds it, and returns what it does.
OpticsAction add_reflectance(CLI::App& app);
OpticsAction add_bragg(CLI::App& app);
OpticsAction add_mie(CLI::App& app);
OpticsAction add_color(CLI::App& app);

/// Short of grazing, where nothing enters.
inline constexpr double flag_angle_max_deg = 89.99;

}  // namespace opal
