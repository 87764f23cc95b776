// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/development.h"

#include <fmt/format.h>

#include <algorithm>

#include "formats/error.h"
#include "formats/film_settings.h"
#include "renderer/host/tone_mapping.h"

namespace opal {

FilmDescription film_of_image(const Image& image, const std::string& file) {
    const auto found = image.attributes.find(film_attribute);
    return found == image.attributes.end() ? FilmDescription{} : parse_film(found->second, file + ": " + film_attribute);
}

Image white_balanced(Image linear, const FilmDescription& taken, const FilmDescription& shown) {
    const bool same_temperature =
        taken.white != IlluminantKind::blackbody || taken.white_temperature_k == shown.white_temperature_k;
    if (taken.white == shown.white && same_temperature) return linear;
    const Matrix3 scene_from_taken = bradford_adaptation(srgb_white, film_white(taken));
    const Matrix3 shown_from_scene = bradford_adaptation(film_white(shown), srgb_white);
    const int r = linear.find_channel("R"), g = linear.find_channel("G"), b = linear.find_channel("B");
    for (int y = 0; y < linear.height; ++y)
        for (int x = 0; x < linear.width; ++x) {
            float* pixel = linear.pixel(x, y);
            const Xyz color = xyz_from_linear_srgb({double(pixel[r]), double(pixel[g]), double(pixel[b])});
            const Rgb3d rgb = linear_srgb_from_xyz(shown_from_scene * (scene_from_taken * color));
            pixel[r] = float(rgb.r);
            pixel[g] = float(rgb.g);
            pixel[b] = float(rgb.b);
        }
    return linear;
}

Image developed(const Image& linear, const FilmDescription& taken, const FilmDescription& shown, const std::string& file) {
    for (const char* channel : {"R", "G", "B"})
        if (linear.find_channel(channel) < 0) throw InputError(fmt::format("{}: has no channel {}", file, channel));
    return tone_mapped(white_balanced(linear, taken, shown), shown.exposure_ev, shown.tone);
}

Image cropped(const Image& image, const PixelWindow& window, const std::string& where) {
    if (window.x0 < image.x0 || window.y0 < image.y0 || window.x0 >= window.x1 || window.y0 >= window.y1 ||
        window.x1 > image.x0 + image.width || window.y1 > image.y0 + image.height)
        throw InputError(
            fmt::format("{} {},{},{},{}: the picture holds x {} to {}, y {} to {}; allowed: x0,y0,x1,y1 within it, "
                        "x0 < x1 and y0 < y1",
                        where, window.x0, window.y0, window.x1, window.y1, image.x0, image.x0 + image.width, image.y0,
                        image.y0 + image.height));
    Image part;
    part.x0 = window.x0;
    part.y0 = window.y0;
    part.width = window.width();
    part.height = window.height();
    part.full_width = image.full_width > 0 ? image.full_width : image.width;
    part.full_height = image.full_height > 0 ? image.full_height : image.height;
    part.channel_names = image.channel_names;
    part.attributes = image.attributes;
    part.pixels.reserve(std::size_t(part.width) * part.height * part.channel_names.size());
    for (int y = window.y0; y < window.y1; ++y) {
        const float* row = image.pixel(window.x0 - image.x0, y - image.y0);
        part.pixels.insert(part.pixels.end(), row, row + std::size_t(part.width) * part.channel_names.size());
    }
    return part;
}

}  // namespace opal
