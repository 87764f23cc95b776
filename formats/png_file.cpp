// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/image.h"

namespace opal {

void write_png(const std::filesystem::path& path, const Image& image) {
    std::vector<std::uint8_t> bytes(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), bytes.begin(), [](float value) {
        return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(std::isfinite(value) ? value : 0.0f, 0.0f, 1.0f)));
    });
    png_image header = {};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    // libpng's own upper bound, so that one pass is enough; the call then says how much it took.
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string encoded(size, '\0');
    if (png_image_write_to_memory(&header, encoded.data(), &size, 0, bytes.data(), 0, nullptr) == 0)
        throw SystemError(fmt::format("{}: cannot be encoded: {}", path.string(), header.message));
    encoded.resize(size);
    write_text_file(path, encoded);
}

}  // namespace opal
