// SPDX-License-Identifier: Apache-2.0
#include "formats/image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "formats/atomic_file.h"
#include "formats/error.h"

namespace opal {
namespace {

/// OpenImageIO's messages can run over several lines; ours are one.
std::string one_line(std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    return message;
}

void write_image(const std::filesystem::path& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* data) {
    AtomicFile file(path);
    const std::string name = file.temporary_path().string();
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
    if (!output) throw InputError(fmt::format("output {}: {}", path.string(), one_line(OIIO::geterror())));
    if (!output->open(name, spec) || !output->write_image(type, data) || !output->close())
        throw SystemError(fmt::format("{}: writing failed: {}", path.string(), one_line(output->geterror())));
    // Libraries below OpenImageIO can lose a late write error (full disk); a file that reads back whole has none.
    const std::unique_ptr<OIIO::ImageInput> check = OIIO::ImageInput::open(name);
    std::vector<float> row(std::size_t(spec.width) * spec.nchannels);
    if (!check || !check->read_scanlines(0, 0, spec.y + spec.height - 1, spec.y + spec.height, 0, 0, spec.nchannels,
                                         OIIO::TypeDesc::FLOAT, row.data()))
        throw SystemError(fmt::format("{}: writing failed: the file does not read back (disk full?)", path.string()));
    file.commit();
}

/// Floats and words of a pixel behind each other, as memory holds them.
std::vector<std::uint32_t> with_words(const Image& image) {
    const std::size_t pixels = std::size_t(image.width) * image.height, floats = image.channel_names.size(),
                      words = image.word_names.size();
    std::vector<std::uint32_t> all(pixels * (floats + words));
    for (std::size_t p = 0; p < pixels; ++p) {
        std::memcpy(all.data() + p * (floats + words), image.pixels.data() + p * floats, floats * sizeof(float));
        std::memcpy(all.data() + p * (floats + words) + floats, image.words.data() + p * words, words * sizeof(std::uint32_t));
    }
    return all;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
    OIIO::ImageSpec spec(image.width, image.height, image.num_channels(), OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channel_names;
    spec.x = image.x0;
    spec.y = image.y0;
    if (image.full_width > 0) spec.full_width = image.full_width;
    if (image.full_height > 0) spec.full_height = image.full_height;
    spec.attribute("compression", "zip");
    // Left out, OpenImageIO fills in the time of writing; the same input must give the same bytes.
    spec.attribute("DateTime", "");
    for (const auto& [key, value] : image.attributes) spec.attribute(key, value);
    if (image.word_names.empty()) {
        write_image(path, spec, OIIO::TypeDesc::FLOAT, image.pixels.data());
        return;
    }
    spec.nchannels += int(image.word_names.size());
    spec.channelnames.insert(spec.channelnames.end(), image.word_names.begin(), image.word_names.end());
    spec.channelformats.assign(image.channel_names.size(), OIIO::TypeDesc::FLOAT);
    spec.channelformats.resize(spec.channelnames.size(), OIIO::TypeDesc::UINT32);
    write_image(path, spec, OIIO::TypeDesc::UNKNOWN, with_words(image).data());
}

void read_words(const std::filesystem::path& path, Image& image) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
    if (!input) throw InputError(fmt::format("{}: not a readable image: {}", path.string(), one_line(OIIO::geterror())));
    const OIIO::ImageSpec& spec = input->spec();
    image.word_names.clear();
    image.words.clear();
    std::vector<std::size_t> places;
    for (std::size_t c = 0; c < spec.channelformats.size(); ++c) {
        if (spec.channelformats[c] == OIIO::TypeDesc::UINT32) {
            image.word_names.push_back(spec.channelnames[c]);
            places.push_back(c);
        } else if (spec.channelformats[c] != OIIO::TypeDesc::FLOAT) {
            return;  // another program's file: it holds no state
        }
    }
    if (places.empty()) return;
    const std::size_t pixels = std::size_t(spec.width) * spec.height, channels = spec.channelformats.size();
    std::vector<std::uint32_t> all(pixels * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, all.data()))
        throw InputError(fmt::format("{}: broken image: {}", path.string(), one_line(input->geterror())));
    image.words.reserve(pixels * places.size());
    for (std::size_t p = 0; p < pixels; ++p)
        for (const std::size_t place : places) image.words.push_back(all[p * channels + place]);
}

Image read_image(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(fmt::format("{}: no such image file", path.string()));
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
    if (!input) throw InputError(fmt::format("{}: not a readable image: {}", path.string(), one_line(OIIO::geterror())));
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1) throw InputError(fmt::format("{}: not a flat image", path.string()));
    Image image;
    image.width = spec.width;
    image.height = spec.height;
    image.x0 = spec.x;
    image.y0 = spec.y;
    if (spec.x != 0 || spec.y != 0 || spec.full_width != spec.width || spec.full_height != spec.height) {
        image.full_width = spec.full_width;
        image.full_height = spec.full_height;
    }
    image.channel_names = spec.channelnames;
    image.pixels.resize(std::size_t(spec.width) * spec.height * spec.nchannels);
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
        if (attribute.type() == OIIO::TypeDesc::STRING) image.attributes[attribute.name().string()] = attribute.get_string();
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        throw InputError(fmt::format("{}: broken image: {}", path.string(), one_line(input->geterror())));
    return image;
}

}  // namespace opal
