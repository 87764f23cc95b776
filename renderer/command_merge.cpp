// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "renderer/host/development.h"
#include "renderer/host/film_parts.h"
#include "renderer/render_command.h"

namespace opal {
namespace {

constexpr const char* footer =
    R"(Adds up pictures of sample ranges of one render (opal-render SCENE --samples A:B), in any order. The result is what one
render of all samples gives: its double-precision sums are equal but for the order of addition, so that the EXR's 32-bit
floats are the same or, rarely, differ in their last bit. Where ranges are missing, the result is a picture of those that
are there, and again a part that can be merged.

Example:
  opal-render scene.toml --spp 512 --samples 0:256 -o a.exr
  opal-render scene.toml --spp 512 --samples 256:512 -o b.exr
  opal-render merge a.exr b.exr -o whole.exr)";

}  // namespace

int command_merge(int argc, char** argv) {
    std::vector<std::filesystem::path> parts;
    std::filesystem::path output;
    CLI::App app("opal-render merge: adds up pictures of sample ranges of one render", "opal-render merge");
    app.footer(footer);
    app.add_option("PART", parts, "pictures made with --samples (.exr)")->required();
    app.add_option("-o,--output", output, "picture to write (.exr); a .png appears beside it")->required();
    if (const std::optional<int> code = parse_command_line(app, argc, argv)) return *code;
    if (output.extension() != ".exr") throw InputError(fmt::format("output {}: the name must end in .exr", output.string()));
    std::filesystem::path png = output;
    png.replace_extension(".png");
    require_writable(output);
    require_writable(png);

    PartMerger merger(read_part(parts.front()));
    for (std::size_t i = 1; i < parts.size(); ++i) merger.add(read_part(parts[i]));
    const Image image = merger.merged();
    const FilmDescription film = film_of_image(image, parts.front().string());
    const Image display = developed(image, film, film, parts.front().string());
    write_exr(output, image);
    write_png(png, display);
    const std::vector<SampleRange> missing = merger.missing();
    if (!missing.empty())
        fmt::print(stderr, "opal-render: warning: samples {} of each pixel are missing; {} is a part again\n",
                   sample_ranges_text(missing), output.string());
    fmt::print("{} and {}: {} parts\n", output.string(), png.filename().string(), parts.size());
    return 0;
}

}  // namespace opal
