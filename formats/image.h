// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace opal {

/// A float image of named channels, interleaved, top row first. Text attributes travel in the file's header. It may be a part of
/// a larger picture: OpenEXR's data window within its display window.
struct Image {
    int width = 0;
    int height = 0;
    int x0 = 0, y0 = 0;                   ///< of the first pixel, within the whole picture
    int full_width = 0, full_height = 0;  ///< of the whole picture; 0: this is the whole
    std::vector<std::string> channel_names;
    std::vector<float> pixels;  ///< [(y * width + x) * channels + c]
    std::map<std::string, std::string> attributes;
    /// Channels of 32-bit unsigned words beside the floats (OpenEXR's UINT), interleaved likewise: what must survive bit for bit.
    std::vector<std::string> word_names;
    std::vector<std::uint32_t> words;

    int num_channels() const { return static_cast<int>(channel_names.size()); }
    const float* pixel(int x, int y) const { return pixels.data() + (std::size_t(y) * width + x) * channel_names.size(); }
    float* pixel(int x, int y) { return pixels.data() + (std::size_t(y) * width + x) * channel_names.size(); }
    /// Index of a channel, or -1.
    int find_channel(const std::string& name) const {
        const auto found = std::find(channel_names.begin(), channel_names.end(), name);
        return found == channel_names.end() ? -1 : static_cast<int>(found - channel_names.begin());
    }
};

// EXR files and reading are in the target opal_images: OpenImageIO takes 120 MB and 0.3 s to load, which programs that only write
// PNG need not spend.

/// OpenEXR, 32-bit float, ZIP, written atomically. Throws InputError (cannot be created) or SystemError (disk full).
void write_exr(const std::filesystem::path& path, const Image& image);

/// 8-bit sRGB PNG from three channels that already are display-encoded values in [0, 1]; written atomically.
void write_png(const std::filesystem::path& path, const Image& image);

/// Reads any image OpenImageIO knows (EXR, HDR, PNG ...) as float, channels of words scaled to [0, 1]. Throws InputError.
Image read_image(const std::filesystem::path& path);

/// Reads the channels of 32-bit words of an EXR whose other channels are 32-bit floats into `image`; none where it has none.
/// Throws InputError.
void read_words(const std::filesystem::path& path, Image& image);

}  // namespace opal
