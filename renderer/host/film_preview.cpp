// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/film_preview.h"

#include <algorithm>

namespace opal {

Image film_preview(const Film& film) {
    Image image;
    image.width = film.width();
    image.height = film.height();
    image.channel_names = {"R", "G", "B"};
    image.pixels.resize(std::size_t(image.width) * image.height * 3);
    for (int b = 0; b < film.num_blocks(); ++b) {
        const PixelWindow window = film.block_window(b);
        const std::scoped_lock lock(film.block(b).lock);
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const std::uint32_t pixel = std::uint32_t(y * film.width() + x);
                const double count = std::max(1u, film.samples(pixel));
                for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = float(film.sums(pixel)[std::size_t(sum_offset + c)] / count);
            }
    }
    return image;
}

}  // namespace opal
