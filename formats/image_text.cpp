// SPDX-License-Identifier: Apache-2.0
#include "formats/image_text.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

namespace opal {
namespace {

/// Extent of a text relative to the left end of its baseline; not defined where the font cannot be found.
OIIO::ROI extent(const std::string& text, const TextStyle& style) {
    const OIIO::ROI roi = OIIO::ImageBufAlgo::text_size(text, style.height_px, style.font);
    if (!roi.defined()) OIIO::geterror();  // the answer says it; an error left unread is printed at exit
    return roi;
}

}  // namespace

int text_width_px(const std::string& text, const TextStyle& style) {
    const OIIO::ROI roi = extent(text, style);
    return roi.defined() ? roi.width() : 0;
}

bool draw_text(Image& image, int x, int y, const std::string& text, const TextStyle& style) {
    const OIIO::ROI roi = extent(text, style);
    if (!roi.defined()) return false;
    if (style.align == TextAlign::center) x -= roi.width() / 2;
    if (style.align == TextAlign::right) x -= roi.width();
    // The middle of a capital letter, so that lines with and without descenders stand on one baseline.
    const int baseline = y + (style.height_px * 36 + 50) / 100;
    OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width, image.height, image.num_channels(), OIIO::TypeDesc::FLOAT),
                          image.pixels.data());
    return OIIO::ImageBufAlgo::render_text(buffer, x, baseline, text, style.height_px, style.font, style.color);
}

}  // namespace opal
