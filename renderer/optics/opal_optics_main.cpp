// SPDX-License-Identifier: Apache-2.0
#include "formats/command.h"
#include "renderer/optics/optics_command.h"

int main(int argc, char** argv) {
    return opal::run_command("opal-optics", [&] { return opal::optics_command(argc, argv); });
}
