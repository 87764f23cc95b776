// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace opal {

/// The command line of opal-render: parses, loads, renders, writes. Returns the exit code; throws InputError and SystemError.
int render_command(int argc, char** argv);

}  // namespace opal
