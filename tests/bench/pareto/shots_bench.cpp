// SPDX-License-Identifier: GPL-3.0-or-later
#include "shots_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
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
    {"wide", {"camera.position_mm=[0.0, -320.0, 240.0]"}, 4, 50},
    {"product", {}, 16, 50},
    {"macro", {"camera.position_mm=[0.0, -12.0, 13.0]", "camera.target_mm=[0.0, -1.5, 4.0]"}, 16, 50},
};

constexpr int num_seeds = 8;
/// Times the samples in the studio: enough for two pictures of one model to be as close as one wants to tell of two models.
constexpr int tent_factor = 8;

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

void bench_shots(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& only) {
    std::filesystem::create_directories(folder);
    AtomicFile file(folder / "shots.csv");
    std::ofstream csv(file.temporary_path());
    csv << "shot,light,model,build_s,file_bytes,memory_bytes,load_s,processor_us_per_sample,samples_per_patch,squared_lab_"
           "difference,"
           "squared_lab_se,ciede2000_p95\n";
    OpalBuilds builds(folder / "shot_opals");
    const ParetoScene example = pareto_scenes(OPAL_EXAMPLES, OPAL_BENCH_BLOCK, true).front();
    const double exposure = std::exp2(0.8);  // the scene's
    for (const Shot& shot : shots) {
        if (!only.empty() && std::find(only.begin(), only.end(), shot.name) == only.end()) continue;
        // opal-model reads a scene's file: the shot's camera goes into a copy.
        ParetoScene scene = example;
        scene.scene = std::filesystem::absolute(folder) / (shot.name + ".toml");
        write_text_file(scene.scene, scene_to_toml(read_scene(example.scene, shot.camera)));
        std::vector<ParetoVariant> models = {
            {"shots", "whole", {fmt::format("grains.voxel_size_mm={}", scene.longest_mm / 512)}, {}},
            {"shots", "--for, 1 pixel", {}, {}},
            {"shots", "--for, 3 pixels", {}, {}}};
        models[1].for_pixels = "1";
        models[2].for_pixels = "3";
        std::vector<std::unique_ptr<Subject>> subjects;
        for (const ParetoVariant& model : models)
            subjects.push_back(std::make_unique<Subject>(
                scene.scene,
                std::vector<std::string>{"object.0.file='" + builds.build(scene, model).file.string() + "'", "render.filter=box"},
                SpectralChoice::continuous));
        const DrawnPatches drawn = spread(subjects.front()->pixels(), subjects.front()->width(), shot);
        const int patch_pixels = shot.patch_edge * shot.patch_edge;
        const int samples = std::max(1, (quick ? 512 : 4096) / patch_pixels);
        for (int seed = 0; seed < num_seeds; ++seed)
            for (const auto& subject : subjects)
                for (const Lighting lighting : {Lighting::of_the_scene, Lighting::tent})
                    subject->draw(drawn.pixels, lighting == Lighting::tent ? tent_factor * samples : samples,
                                  7000 + std::uint64_t(seed), lighting);
        const std::vector<double> weights(drawn.patches.size(), 1.0 / double(drawn.patches.size()));
        for (std::size_t k = 0; k < 2 * models.size(); ++k) {
            const Lighting lighting = k < models.size() ? Lighting::of_the_scene : Lighting::tent;
            const std::size_t i = k % models.size();
            const OpalBuild& opal = builds.build(scene, models[i]);
            const SeedPictures whole = patch_means(subjects.front()->pictures(lighting), drawn.patches);
            const SeedPictures patches = patch_means(subjects[i]->pictures(lighting), drawn.patches);
            const std::vector<Opponent> first = mean_over(whole, 0, num_seeds / 2);
            const Estimate difference = squared_bias(shown(patches, exposure), shown(whole, exposure), weights);
            const std::string line = fmt::format(
                "{},{},\"{}\",{:.3g},{},{},{:.3g},{:.4g},{},{:.4g},{:.2g},{:.3g}", shot.name,
                lighting == Lighting::tent ? "tent" : "studio", models[i].name, opal.processor_s, opal.bytes,
                subjects[i]->memory_bytes(), subjects[i]->load_s(), 1e6 * mean_of(subjects[i]->sample_s()).value,
                (lighting == Lighting::tent ? tent_factor : 1) * samples * patch_pixels * num_seeds, difference.value,
                difference.standard_error, percentile_95(first, mean_over(patches, num_seeds / 2, num_seeds), exposure));
            csv << line << '\n';
            fmt::print("{}\n", line);
        }
        std::fflush(stdout);
        std::filesystem::remove(scene.scene);
    }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "shots.csv").string()));
    file.commit();
}

}  // namespace opal
