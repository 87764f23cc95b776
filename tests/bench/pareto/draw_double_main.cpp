// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "formats/command.h"
#include "formats/error.h"
#include "subject.h"

static_assert(sizeof(opal::real) == sizeof(double));

namespace {

std::vector<std::uint32_t> listed_pixels(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t pixel = 0; file >> pixel;) pixels.push_back(pixel);
    if (pixels.empty() || !file.eof()) throw opal::InputError(path.string() + ": no list of pixels");
    return pixels;
}

/// Writes bytes of memory, seconds of loading, processor time per sample, then the pixels' colours in their order.
int draw(int argc, char** argv) {
    std::filesystem::path scene, pixels, output;
    std::vector<std::string> settings;
    int samples = 1;
    std::uint64_t seed = 1;
    bool tent = false;
    CLI::App app("Draws pixels of a scene in double precision, for opal-bench pareto.", "opal-draw-double");
    app.add_option("scene", scene, "scene file")->required();
    app.add_option("--pixels", pixels, "file with the numbers of the pixels")->required();
    app.add_option("-o,--output", output, "file for their mean opponent colours")->required();
    app.add_option("--set", settings, "override of the scene; repeatable");
    app.add_option("--samples", samples, "per pixel")->check(CLI::Range(1, 1 << 20));
    app.add_option("--seed", seed);
    app.add_flag("--tent", tent, "in the light tent instead of the scene's own light");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        throw opal::InputError(fmt::format("{} (see opal-draw-double --help)", error.what()));
    }
    opal::Subject subject(scene, settings, opal::SpectralChoice::continuous, opal::Tracing::own_tree_in_double);
    const opal::Lighting lighting = tent ? opal::Lighting::tent : opal::Lighting::of_the_scene;
    subject.draw(listed_pixels(pixels), samples, seed, lighting);
    std::ofstream file(output);
    file << fmt::format("{} {:.17g} {:.17g}\n", subject.memory_bytes(), subject.load_s(),
                        tent ? 0.0 : subject.sample_s().front());
    for (const opal::Opponent& color : subject.pictures(lighting).front())
        file << fmt::format("{:.17g} {:.17g} {:.17g}\n", color[0], color[1], color[2]);
    file.close();
    if (!file) throw opal::SystemError(output.string() + ": writing failed");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return opal::run_command("opal-draw-double", [&] { return draw(argc, argv); });
}
