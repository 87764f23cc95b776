// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_chart.h"

#include <fmt/format.h>

#include <cstdlib>

namespace opal {

void draw_chart(const std::string& script, const std::filesystem::path& csv) {
    std::filesystem::path picture = csv;
    picture.replace_extension(".png");
    const std::string arguments = fmt::format("'{}/{}' '{}' '{}'", OPAL_CHARTS, script, csv.string(), picture.string());
    for (const char* python : {"python3", "/usr/bin/python3"}) {
        const bool can_draw = std::system(fmt::format("{} -c 'import matplotlib' > /dev/null 2>&1", python).c_str()) == 0;
        if (can_draw && std::system(fmt::format("{} {}", python, arguments).c_str()) == 0) {
            fmt::print("{}\n", picture.string());
            return;
        }
    }
    fmt::print(stderr, "opal-bench: note: no chart; with matplotlib (Debian: python3-matplotlib), python3 {} draws it\n",
               arguments);
}

}  // namespace opal
