// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/film_settings.h"
#include "formats/number_option.h"
#include "formats/text.h"
#include "renderer/host/development.h"
#include "renderer/host/finite_pixels.h"
#include "renderer/pixel_window_flag.h"
#include "renderer/render_command.h"

namespace opal {
namespace {

struct DevelopOptions {
    std::filesystem::path picture, output;
    std::optional<double> exposure_ev;
    std::string white, tone, crop;
    bool blacken = false;
};

constexpr const char* footer =
    R"(Makes the PNG of a rendered EXR anew. What no flag says is as in the scene that made the EXR, so that without flags the
PNG is the render's own, byte for byte.

  --white   what is shown as white: D65, A, E, or a black body's temperature such as 3200K. The EXR's RGB goes back to XYZ
            and is adapted anew by Bradford's matrix.
  --tone    filmic: highlights roll off above 0.7 and keep their hue; srgb: plain sRGB; none: linear; both cut at 1

Examples:
  opal-render develop out/precious_opal.exr -o bright.png --exposure 1.5
  opal-render develop out/precious_opal.exr -o lamplight.png --white 2856K --crop 300,200,660,520)";

}  // namespace

int command_develop(int argc, char** argv) {
    DevelopOptions options;
    CLI::App app("opal-render develop: exposure, white balance and tone of a picture, from its EXR", "opal-render develop");
    app.footer(footer);
    app.add_option("IN", options.picture, "the picture (.exr)")->required();
    app.add_option("-o,--output", options.output, "picture to write (.png)")->required();
    app.add_option("--exposure", options.exposure_ev, "stops brighter than the linear picture")
        ->check(number_between(-40.0, 40.0));
    app.add_option("--white", options.white, "D65, A, E or a temperature such as 6500K");
    app.add_option("--tone", options.tone, "filmic, srgb or none")->check(CLI::IsMember(tone_names));
    app.add_option("--crop", options.crop, "x0,y0,x1,y1: pixels of the whole picture, the ends not counted");
    app.add_flag("--blacken", options.blacken, "show pixels that are not finite numbers as black (default: refuse the picture)");
    if (const std::optional<int> code = parse_command_line(app, argc, argv)) return *code;
    if (options.output.extension() != ".png")
        throw InputError(fmt::format("output {}: the name must end in .png", options.output.string()));
    require_writable(options.output);

    Image picture = read_image(options.picture);
    const std::string file = options.picture.string();
    const FilmDescription taken = film_of_image(picture, file);
    FilmDescription shown = taken;
    if (options.exposure_ev) shown.exposure_ev = *options.exposure_ev;
    if (!options.white.empty()) set_white(shown, options.white, "--white");
    if (!options.tone.empty())
        shown.tone = static_cast<ToneCurve>(std::find(tone_names.begin(), tone_names.end(), options.tone) - tone_names.begin());
    if (!options.crop.empty()) picture = cropped(picture, parse_pixel_window(options.crop), "--crop");
    if (const std::optional<BrokenPixels> broken = find_broken_pixels(picture)) {
        if (!options.blacken) throw InputError(describe(*broken, file) + "; --blacken shows such pixels as black");
        fmt::print(stderr, "opal-render: warning: {}; shown as black\n", one_line(describe(*broken, file)));
        blacken_broken_pixels(picture);
    }
    write_png(options.output, developed(picture, taken, shown, file));
    return 0;
}

}  // namespace opal
