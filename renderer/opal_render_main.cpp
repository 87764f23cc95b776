// SPDX-License-Identifier: Apache-2.0
#include "formats/command.h"
#include "renderer/render_command.h"

int main(int argc, char** argv) {
    return opal::run_command("opal-render", [&] { return opal::opal_render(argc, argv); });
}
