// SPDX-License-Identifier: Apache-2.0
#include "renderer/pixel_window_flag.h"

#include <fmt/format.h>

#include <charconv>

#include "formats/error.h"

namespace opal {

PixelWindow parse_pixel_window(const std::string& text) {
    int edges[4] = {};
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (int i = 0; i < 4; ++i) {
        if (i > 0 && (at == end || *at++ != ',')) at = end + 1;
        const auto [next, error] =
            at <= end ? std::from_chars(at, end, edges[i]) : std::from_chars_result{end, std::errc::invalid_argument};
        if (error != std::errc()) throw InputError(fmt::format("--crop {}: expected four whole numbers, x0,y0,x1,y1", text));
        at = next;
    }
    if (at != end) throw InputError(fmt::format("--crop {}: expected four whole numbers, x0,y0,x1,y1", text));
    return {edges[0], edges[1], edges[2], edges[3]};
}

}  // namespace opal
