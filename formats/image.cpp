// SPDX-License-Identifier: Apache-2.0
#include "formats/image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

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
    write_image(path, spec, OIIO::TypeDesc::FLOAT, image.pixels.data());
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
