// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/atomic_file.h"
#include "formats/error.h"
#include "formats/number_option.h"
#include "renderer/host/development.h"
#include "renderer/host/image_comparison.h"
#include "renderer/render_command.h"

namespace opal {
namespace {

struct CompareOptions {
    std::filesystem::path picture, reference, difference;
    std::optional<double> exposure_ev;
    bool json = false;
};

constexpr const char* footer = R"(Errors of A against the reference B, from linear sRGB:
  relMSE      mean of (a - b)^2 / (b^2 + 0.01 m^2) over pixels and R, G, B; m is the mean of B
  mean ratio  mean of A over mean of B: R, G, B
  PSNR, CIEDE2000 (mean, 95th percentile over pixels) of both pictures as shown, at B's exposure
  z           |a - b| in standard errors, where both pictures hold variances: the share beyond 2, 3 and 4 (noise alone:
              4.55, 0.27 and 0.0063 %), and z of the pictures' mean R, G, B (noise alone: within 3)

Example:
  opal-render compare draft.exr final.exr --json)";

/// JSON has no infinity: the PSNR of equal pictures is null.
nlohmann::json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

void print_json(const ImageComparison& comparison, double exposure_ev) {
    nlohmann::json report = {{"relative_mse", comparison.relative_mse},
                             {"psnr_db", finite_or_null(comparison.psnr_db)},
                             {"mean_ratio_rgb", nlohmann::json::array()},
                             {"delta_e_2000", {{"mean", comparison.delta_e_mean}, {"percentile_95", comparison.delta_e_95}}},
                             {"exposure_ev", exposure_ev},
                             {"z", nullptr}};
    for (const double ratio : comparison.mean_ratio) report["mean_ratio_rgb"].push_back(finite_or_null(ratio));
    if (const std::optional<NoiseTest>& test = comparison.noise_test)
        report["z"] = {{"beyond_2", test->beyond_2_sigma},
                       {"beyond_3", test->beyond_3_sigma},
                       {"beyond_4", test->beyond_4_sigma},
                       {"mean_rgb", test->mean_z}};
    fmt::print("{}\n", report.dump(2));
}

void print_text(const ImageComparison& comparison) {
    fmt::print("relMSE      {:.6g}\n", comparison.relative_mse);
    fmt::print("PSNR        {:.2f} dB\n", comparison.psnr_db);
    fmt::print("mean ratio  {:.6f} {:.6f} {:.6f}\n", comparison.mean_ratio[0], comparison.mean_ratio[1],
               comparison.mean_ratio[2]);
    fmt::print("CIEDE2000   mean {:.3f}, 95th percentile {:.3f}\n", comparison.delta_e_mean, comparison.delta_e_95);
    if (const std::optional<NoiseTest>& test = comparison.noise_test)
        fmt::print("z           {:.3f} % beyond 2, {:.3f} % beyond 3, {:.4f} % beyond 4; of the mean {:.2f} {:.2f} {:.2f}\n",
                   100.0 * test->beyond_2_sigma, 100.0 * test->beyond_3_sigma, 100.0 * test->beyond_4_sigma, test->mean_z[0],
                   test->mean_z[1], test->mean_z[2]);
    else
        fmt::print("z           not known: it needs variances in both pictures\n");
}

}  // namespace

int command_compare(int argc, char** argv) {
    CompareOptions options;
    CLI::App app("opal-render compare: says how a picture differs from a reference", "opal-render compare");
    app.footer(footer);
    app.add_option("A", options.picture, "the picture (.exr)")->required();
    app.add_option("B", options.reference, "the reference (.exr)")->required();
    app.add_option("--exposure-ev", options.exposure_ev, "stops by which both are shown brighter (default: as B's scene asks)")
        ->check(number_between(-40.0, 40.0));
    app.add_option("--difference", options.difference, "write A - B and CIEDE2000 per pixel (.exr)");
    app.add_flag("--json", options.json, "print JSON");
    if (const std::optional<int> code = parse_command_line(app, argc, argv)) return *code;
    if (!options.difference.empty()) {
        if (options.difference.extension() != ".exr")
            throw InputError(fmt::format("--difference {}: the name must end in .exr", options.difference.string()));
        require_writable(options.difference);
    }

    const Image picture = read_image(options.picture), reference = read_image(options.reference);
    const double exposure_ev =
        options.exposure_ev ? *options.exposure_ev : film_of_image(reference, options.reference.string()).exposure_ev;
    const ImageComparison comparison =
        compare_images(picture, reference, exposure_ev, options.picture.string(), options.reference.string());
    if (!options.difference.empty()) write_exr(options.difference, comparison.difference);
    if (options.json)
        print_json(comparison, exposure_ev);
    else
        print_text(comparison);
    return 0;
}

}  // namespace opal
