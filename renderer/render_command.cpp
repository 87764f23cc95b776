// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string_view>

#include "formats/error.h"
#include "formats_generated/version.h"

namespace opal {
namespace {

struct Command {
    std::string_view name;
    int (*run)(int argc, char** argv);
};

constexpr Command commands[] = {{"compare", command_compare}, {"develop", command_develop}, {"merge", command_merge}};

}  // namespace

int opal_render(int argc, char** argv) {
    for (const Command& command : commands)
        if (argc > 1 && command.name == argv[1]) return command.run(argc - 1, argv + 1);
    return command_render(argc, argv);
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
    app.set_version_flag("--version", std::string("opal-render ") + OPAL_VERSION_STRING);
    if (app.get_name().empty()) app.name("opal-render");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("{} ({} --help shows the options)", error.what(), app.get_name()));
    }
    return std::nullopt;
}

}  // namespace opal
