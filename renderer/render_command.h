// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace CLI {
class App;
}

namespace opal {

/// The command line of opal-render: one of the commands below by its name as the first word, else a render. Returns the exit
/// code; throws InputError and SystemError, as they do.
int opal_render(int argc, char** argv);

/// Renders a scene: opal-render SCENE -o OUT.exr.
int command_render(int argc, char** argv);
/// Adds up pictures of sample ranges: opal-render merge PART.exr... -o OUT.exr. `argv[0]` is the command's name.
int command_merge(int argc, char** argv);
/// Says how two pictures differ: opal-render compare A.exr B.exr. `argv[0]` is the command's name.
int command_compare(int argc, char** argv);
/// Makes a picture's PNG anew: opal-render develop IN.exr -o OUT.png. `argv[0]` is the command's name.
int command_develop(int argc, char** argv);

/// Parses. Returns an exit code where the command line alone decides (help, version). Throws InputError.
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

}  // namespace opal
