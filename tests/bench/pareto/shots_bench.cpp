// SPDX-License-Identifier: GPL-3.0-or-later
#include "shots_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "formats/atomic_file.h"
#include "formats/colorimetry.h"
#include "formats/error.h"
#include "opal_builds.h"
#include "subject.h"
#include "variants.h"

namespace opal {
namespace {

/// A view of the gem at full size, of which some pixels are drawn.
struct Shot {
    std::string name;
    std::vector<std::string> camera;
    int patch_edge;
    int patches;  ///< drawn, spread over the gem
};

const std::vector<Shot> shots = {
    {"wide", {"camera.position_mm=[0.0, -320.0, 240.0]"}, 4, 100},
    {"product", {}, 16, 100},
    {"macro", {"camera.position_mm=[0.0, -12.0, 13.0]", "camera.target_mm=[0.0, -1.5, 4.0]"}, 16, 100},
};

constexpr int num_seeds = 8;

/// Every n-th of the patches, so that about as many are left as are wanted, as their pixels in rows and their shares of them.
struct DrawnPatches {
    std::vector<std::uint32_t> pixels;
    Patches patches;
};

DrawnPatches spread(const std::vector<std::uint32_t>& gem, int width, const Shot& shot) {
    const Patches all = patches_of(gem, width, shot.patch_edge);
    const std::size_t step = std::max<std::size_t>(1, all.size() / std::size_t(shot.patches));
    DrawnPatches drawn;
    for (std::size_t i = step / 2; i < all.size(); i += step) {
        drawn.patches.emplace_back();
        for (const std::size_t p : all[i]) {
            drawn.patches.back().push_back(drawn.pixels.size());
            drawn.pixels.push_back(gem[p]);
        }
    }
    return drawn;
}

/// As shown: CIELAB of a patch, its three coordinates in place of the opponent colours.
Opponent shown(const Opponent& color, double exposure) {
    const Lab lab = lab_from_xyz(
        {exposure * (color[1] + color[0]) * srgb_white.x, exposure * color[0], exposure * (color[2] + color[0]) * srgb_white.z},
        srgb_white);
    return {lab.l, lab.a, lab.b};
}

SeedPictures shown(const SeedPictures& patches, double exposure) {
    SeedPictures result = patches;
    for (auto& seed : result)
        for (Opponent& patch : seed) patch = shown(patch, exposure);
    return result;
}

/// Mean over the seeds [first, end).
std::vector<Opponent> mean_over(const SeedPictures& patches, std::size_t first, std::size_t end) {
    std::vector<Opponent> mean(patches.front().size(), Opponent{});
    for (std::size_t k = first; k < end; ++k)
        for (std::size_t p = 0; p < mean.size(); ++p)
            for (std::size_t c = 0; c < 3; ++c) mean[p][c] += patches[k][p][c] / double(end - first);
    return mean;
}

/// 95 % of the patches differ by less.
double percentile_95(const std::vector<Opponent>& a, const std::vector<Opponent>& b, double exposure) {
    std::vector<double> differences;
    for (std::size_t p = 0; p < a.size(); ++p) {
        const Opponent first = shown(a[p], exposure), second = shown(b[p], exposure);
        differences.push_back(delta_e_2000({first[0], first[1], first[2]}, {second[0], second[1], second[2]}));
    }
    std::sort(differences.begin(), differences.end());
    return differences[std::size_t(0.95 * double(differences.size() - 1))];
}

}  // namespace

void bench_shots(const std::filesystem::path& folder, bool quick) {
    std::filesystem::create_directories(folder);
    AtomicFile file(folder / "shots.csv");
    std::ofstream csv(file.temporary_path());
    csv << "shot,model,build_s,file_bytes,memory_bytes,load_s,processor_us_per_sample,samples_per_patch,squared_lab_difference,"
           "squared_lab_se,ciede2000_p95_models,ciede2000_p95_noise\n";
    OpalBuilds builds(folder / "shot_opals");
    const ParetoScene example = pareto_scenes(OPAL_EXAMPLES, OPAL_BENCH_BLOCK, true).front();
    const double exposure = std::exp2(0.8);  // the scene's
    for (const Shot& shot : shots) {
        // opal-model reads a scene's file: the shot's camera goes into a copy.
        ParetoScene scene = example;
        scene.scene = std::filesystem::absolute(folder) / (shot.name + ".toml");
        write_text_file(scene.scene, scene_to_toml(read_scene(example.scene, shot.camera)));
        const ParetoVariant whole{"shots", "whole", {fmt::format("grains.voxel_size_mm={}", scene.longest_mm / 512)}, {}};
        ParetoVariant fitted{"shots", "--for, 3 pixels", {}, {}};
        fitted.for_pixels = "3";
        const OpalBuild whole_opal = builds.build(scene, whole), fitted_opal = builds.build(scene, fitted);
        const auto settings = [](const OpalBuild& opal) {
            return std::vector<std::string>{"object.0.file='" + opal.file.string() + "'", "render.filter=box"};
        };
        Subject whole_subject(scene.scene, settings(whole_opal), SpectralChoice::continuous);
        Subject fitted_subject(scene.scene, settings(fitted_opal), SpectralChoice::continuous);
        const DrawnPatches drawn = spread(whole_subject.pixels(), whole_subject.width(), shot);
        const int patch_pixels = shot.patch_edge * shot.patch_edge;
        const int samples = std::max(1, (quick ? 512 : 8192) / patch_pixels);
        for (int seed = 0; seed < num_seeds; ++seed)
            for (Subject* const subject : {&whole_subject, &fitted_subject})
                subject->draw(drawn.pixels, samples, 7000 + std::uint64_t(seed));
        const SeedPictures a = patch_means(whole_subject.pictures(), drawn.patches),
                           b = patch_means(fitted_subject.pictures(), drawn.patches);
        const std::vector<double> weights(drawn.patches.size(), 1.0 / double(drawn.patches.size()));
        const Estimate difference = squared_bias(shown(a, exposure), shown(b, exposure), weights);
        const double models = percentile_95(mean_over(a, 0, num_seeds / 2), mean_over(b, num_seeds / 2, num_seeds), exposure);
        const double noise = percentile_95(mean_over(a, 0, num_seeds / 2), mean_over(a, num_seeds / 2, num_seeds), exposure);
        const auto line = [&](const ParetoVariant& variant, const OpalBuild& opal, const Subject& subject) {
            return fmt::format("{},\"{}\",{:.3g},{},{},{:.3g},{:.4g},{}", shot.name, variant.name, opal.processor_s, opal.bytes,
                               subject.memory_bytes(), subject.load_s(), 1e6 * mean_of(subject.sample_s()).value,
                               samples * patch_pixels * num_seeds);
        };
        const std::string of_whole = line(whole, whole_opal, whole_subject) + ",,,,";
        const std::string of_fitted =
            line(fitted, fitted_opal, fitted_subject) +
            fmt::format(",{:.4g},{:.2g},{:.3g},{:.3g}", difference.value, difference.standard_error, models, noise);
        csv << of_whole << '\n' << of_fitted << '\n';
        fmt::print("{}\n{}\n", of_whole, of_fitted);
        std::fflush(stdout);
        std::filesystem::remove(scene.scene);
    }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "shots.csv").string()));
    file.commit();
}

}  // namespace opal
