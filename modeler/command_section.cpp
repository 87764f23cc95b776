// SPDX-License-Identifier: GPL-3.0-or-later
#include "modeler/command_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/image_text.h"
#include "formats/opal_asset.h"
#include "formats/text.h"
#include "modeler/section_picture.h"

namespace opal {
namespace {

constexpr int single_size_px = 800, sheet_size_px = 400;
/// Of a sheet's sections together: about 3 GB while it is drawn.
constexpr double max_pixels = 0x1p25;
const std::vector<std::string> axis_names = {"x", "y", "z"};

int choice(const char* flag, const std::string& name, const std::vector<std::string>& names) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        const std::string suggestion = name.size() > 1 ? did_you_mean(name, names) : "";
        throw InputError(fmt::format("{} {}: not known{} (allowed: {})", flag, name, suggestion, join(names)));
    }
    return static_cast<int>(found - names.begin());
}

SectionRequest request_of(const SectionArguments& arguments) {
    SectionRequest request;
    request.axis = choice("--axis", arguments.axis, axis_names);
    request.color = static_cast<SectionColor>(choice("--color", arguments.color, section_color_names()));
    request.slices = arguments.slices;
    if (!arguments.at_mm.empty()) {
        if (arguments.slices > 1) throw InputError("--at and --slices: one section, or several spread evenly; not both");
        std::size_t end = 0;
        try {
            request.at_mm = std::stod(arguments.at_mm, &end);
        } catch (const std::exception&) {
        }
        if (!request.at_mm || end != arguments.at_mm.size() || !std::isfinite(*request.at_mm))
            throw InputError(fmt::format("--at {}: expected a number, in mm", arguments.at_mm));
    }
    const std::size_t sections = arguments.files.size() * static_cast<std::size_t>(arguments.slices);
    request.size_px = arguments.size_px > 0 ? arguments.size_px : sections == 1 ? single_size_px : sheet_size_px;
    const double pixels = static_cast<double>(sections) * request.size_px * request.size_px;
    if (pixels > max_pixels)
        throw InputError(fmt::format("--size {}: {} sections of that size are too large for one picture; allowed: up to {:.0f}",
                                     request.size_px, sections, std::sqrt(max_pixels / static_cast<double>(sections))));
    return request;
}

}  // namespace

CLI::App* add_section(CLI::App& app, SectionArguments& arguments) {
    CLI::App* const section = app.add_subcommand("section", "Draw a cut through an opal, or a sheet of several, as a PNG");
    section->add_option("FILE", arguments.files, "opal .vdb; several are drawn side by side in one scale")->required();
    section->add_option("-o,--output", arguments.output_file, "file to write, ending in .png")->required()->type_name("OUT.png");
    section->add_option("--axis", arguments.axis, "cut across x, y or z (default z)")->type_name("AXIS");
    section->add_option("--at", arguments.at_mm, "where along the axis, in mm (default: the middle of the opal)")
        ->type_name("MM");
    section->add_option("--slices", arguments.slices, "so many sections, spread evenly along the axis, on one sheet")
        ->check(CLI::Range(1, 100))
        ->type_name("N");
    section->add_option("--color", arguments.color, "what is shown: " + join(section_color_names()) + " (default grain)")
        ->type_name("WHAT");
    section
        ->add_option(
            "--size", arguments.size_px,
            fmt::format("pixels along the longer side of a section (default {}, {} on a sheet)", single_size_px, sheet_size_px))
        ->check(CLI::Range(64, 4096))
        ->type_name("PIXELS");
    return section;
}

int run_section(const SectionArguments& arguments) {
    const SectionRequest request = request_of(arguments);
    const std::filesystem::path output(arguments.output_file);
    if (output.extension() != ".png") throw InputError(fmt::format("output {}: the name must end in .png", output.string()));
    require_writable(output);
    catch_interrupts();
    std::vector<OpalAsset> assets;
    for (const std::string& file : arguments.files) {
        std::vector<std::string> notices;
        assets.push_back(read_opal_asset(file, {}, notices));
        for (const std::string& notice : notices) fmt::print(stderr, "opal-model: notice: {}\n", one_line(file + ": " + notice));
        throw_if_interrupted();
    }
    std::vector<SectionSubject> subjects;
    for (std::size_t n = 0; n < assets.size(); ++n)
        subjects.push_back({&assets[n], arguments.files[n], std::filesystem::path(arguments.files[n]).stem().string()});
    write_png(output, draw_sections(subjects, request));
    if (text_width_px("mm", {}) == 0)
        fmt::print(stderr, "opal-model: notice: no font found (package fonts-dejavu-core): the picture has no text\n");
    return 0;
}

}  // namespace opal
