// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "formats/image.h"

namespace opal {

enum class TextAlign { left, center, right };

struct TextStyle {
    int height_px = 16;  ///< nominal height of a line
    TextAlign align = TextAlign::left;
    std::array<float, 3> color = {0.0f, 0.0f, 0.0f};
    std::string font = "DejaVuSans";  ///< a font file's name without its folder; Debian: package fonts-dejavu-core
};

/// Writes one line of text into a three-channel image, (x, y) being the middle of its left end, its centre or the middle of its
/// right end. Parts beyond the image are cut. Returns false, with the image as it was, where the font cannot be found.
bool draw_text(Image& image, int x, int y, const std::string& text, const TextStyle& style);

/// Width of a line of text; 0 where the font cannot be found.
int text_width_px(const std::string& text, const TextStyle& style);

}  // namespace opal
