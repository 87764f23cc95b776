// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/command.h"
#include "modeler/command_line.h"

int main(int argc, char** argv) {
    return opal::run_command("opal-model", [&] { return opal::run_opal_model(argc, argv); });
}
