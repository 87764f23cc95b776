// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace opal {

/// Parses the arguments of opal-model and carries out its command. Returns the exit code; throws InputError for arguments that
/// make no sense.
int run_opal_model(int argc, char** argv);

}  // namespace opal
