// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../renderer/small_opal.h"
#include "formats/image.h"
#include "run_program.h"

namespace opal {
namespace {

constexpr int hue_bins = 12;
constexpr int unsaturated = -1;

/// Hue bin (30 degrees each) of an 8-bit display colour, or `unsaturated` where its HSV saturation is at most 0.5.
int hue_bin(const float* rgb) {
    const float high = std::max({rgb[0], rgb[1], rgb[2]}), low = std::min({rgb[0], rgb[1], rgb[2]});
    if (!(high > 0.0f) || (high - low) / high <= 0.5f) return unsaturated;
    const float chroma = high - low;
    float sixth = rgb[0] == high ? (rgb[1] - rgb[2]) / chroma : (rgb[1] == high ? 2.0f + (rgb[2] - rgb[0]) / chroma : 4.0f + (rgb[0] - rgb[1]) / chroma);
    if (sixth < 0.0f) sixth += 6.0f;
    return std::min(hue_bins - 1, int(2.0f * sixth));
}

struct Picture {
    Image linear;   ///< with object_id and grain_id
    Image display;  ///< the PNG
};

/// The quickstart's opal and scene, rendered small.
class PreciousOpal : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new ScratchFolder;
        const ProgramResult result =
            run_program(opal_model + " build " + examples + "/precious_opal/recipe.toml -o " + (*folder_ / "opal.vdb").string());
        ASSERT_EQ(result.exit_code, 0) << result.err;
        lit_ = new Picture(render("lit", 0.0));
        turned_ = new Picture(render("turned", 10.0));
    }
    static void TearDownTestSuite() {
        delete lit_;
        delete turned_;
        delete folder_;
    }

    static Picture render(const std::string& name, double rotate_deg) {
        const ProgramResult result = run_program(
            opal_render + " " + examples + "/precious_opal/scene.toml -o " + (*folder_ / (name + ".exr")).string() + " --set object.0.file=" +
            (*folder_ / "opal.vdb").string() + " --set render.width=240 --set render.height=180 --spp 128 --set environment.rotate_deg=" +
            std::to_string(rotate_deg));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return {read_image(*folder_ / (name + ".exr")), read_image(*folder_ / (name + ".png"))};
    }

    static bool is_gem(const Picture& picture, int x, int y) {
        return picture.linear.pixel(x, y)[picture.linear.find_channel("object_id")] == 0.0f;
    }

    /// Display colours averaged over 3x3 gem pixels: what the eye sees of a still noisy small render.
    static std::array<float, 3> smoothed(const Picture& picture, int x, int y) {
        std::array<float, 3> sum = {};
        int count = 0;
        for (int j = std::max(0, y - 1); j <= std::min(picture.display.height - 1, y + 1); ++j)
            for (int i = std::max(0, x - 1); i <= std::min(picture.display.width - 1, x + 1); ++i) {
                if (!is_gem(picture, i, j)) continue;
                for (int c = 0; c < 3; ++c) sum[std::size_t(c)] += picture.display.pixel(i, j)[c];
                ++count;
            }
        for (float& value : sum) value /= float(count);
        return sum;
    }

    static ScratchFolder* folder_;
    static Picture* lit_;
    static Picture* turned_;
};

ScratchFolder* PreciousOpal::folder_ = nullptr;
Picture* PreciousOpal::lit_ = nullptr;
Picture* PreciousOpal::turned_ = nullptr;

TEST_F(PreciousOpal, ShowsSaturatedColorsOfManyHues) {
    int gem = 0, saturated = 0;
    std::array<int, hue_bins> counts = {};
    for (int y = 0; y < lit_->display.height; ++y)
        for (int x = 0; x < lit_->display.width; ++x) {
            if (!is_gem(*lit_, x, y)) continue;
            ++gem;
            const int bin = hue_bin(smoothed(*lit_, x, y).data());
            if (bin == unsaturated) continue;
            ++saturated;
            ++counts[std::size_t(bin)];
        }
    ASSERT_GT(gem, 4000);
    EXPECT_GE(saturated, 0.15 * gem);
    // A hue counts where it covers a half per cent of the gem.
    const auto hues = std::count_if(counts.begin(), counts.end(), [&](int count) { return count >= 0.005 * gem; });
    EXPECT_GE(hues, 5);
    RecordProperty("saturated_percent", 100 * saturated / gem);
    RecordProperty("hues", int(hues));
    std::printf("saturated %.1f %% of the gem, in %d hues\n", 100.0 * saturated / gem, int(hues));
}

TEST_F(PreciousOpal, ColorsChangeWhenTheLightTurns) {
    int saturated = 0, changed = 0;
    for (int y = 0; y < lit_->display.height; ++y)
        for (int x = 0; x < lit_->display.width; ++x) {
            if (!is_gem(*lit_, x, y)) continue;
            const int bin = hue_bin(smoothed(*lit_, x, y).data());
            if (bin == unsaturated) continue;
            ++saturated;
            changed += hue_bin(smoothed(*turned_, x, y).data()) != bin ? 1 : 0;
        }
    EXPECT_GE(changed, 0.30 * saturated);
    std::printf("turning the light by 10 degrees changes the hue of %.1f %% of the saturated pixels\n", 100.0 * changed / saturated);
}

TEST_F(PreciousOpal, BodyIsDarkAndTheStandIsLit) {
    std::vector<float> gem, stand;
    for (int y = 0; y < lit_->linear.height; ++y)
        for (int x = 0; x < lit_->linear.width; ++x) {
            const float* pixel = lit_->linear.pixel(x, y);
            const float object = pixel[lit_->linear.find_channel("object_id")];
            const float luminance = 0.2126f * pixel[lit_->linear.find_channel("R")] + 0.7152f * pixel[lit_->linear.find_channel("G")] +
                                    0.0722f * pixel[lit_->linear.find_channel("B")];
            if (object == 0.0f) gem.push_back(luminance);
            if (object == 1.0f) stand.push_back(luminance);
        }
    std::sort(gem.begin(), gem.end());
    std::sort(stand.begin(), stand.end());
    ASSERT_GT(stand.size(), 1000u);
    // Black opal: half of the gem is several times darker than the stand; the soft boxes' reflections outshine the stand.
    EXPECT_LT(gem[gem.size() / 2], 0.25f * stand[stand.size() / 2]);
    EXPECT_GT(gem[gem.size() * 199 / 200], 0.5f * stand[stand.size() / 2]);
    // The gem's shadow: the darkest part of the stand is well below its middle.
    EXPECT_LT(stand[stand.size() / 50], 0.7f * stand[stand.size() / 2]);
}

/// Sizes on the picture follow the recipe. All sites lie inside the shape, so what its face shows is the outermost layer of cells: n sites
/// per volume are n^(-1/3) apart and such a layer holds n^(2/3) cells per area, a little fewer since elimination leaves the cells at the
/// face larger. (A plane through the interior would cut 1.458 n^(2/3) Poisson-Voronoi cells.)
TEST_F(PreciousOpal, GrainSizeMatchesTheRecipe) {
    for (const int sites : {300, 2400}) {
        const std::string vdb = (*folder_ / ("ball" + std::to_string(sites) + ".vdb")).string();
        const ProgramResult built = run_program(opal_model + " build " + examples + "/precious_opal/recipe.toml -o " + vdb +
                                                " --set shape.kind=box --set shape.size_mm=[10.0,10.0,5.0] --set grains.num_sites=" +
                                                std::to_string(sites) + " --set grains.sintering.probability=0.0");
        ASSERT_EQ(built.exit_code, 0) << built.err;
        const Rendered rendered = render_text(
            "[render]\nwidth = 400\nheight = 400\n[film]\naovs = [\"grain_id\"]\n[camera]\nkind = \"orthographic\"\nposition_mm = [0, 0, 50]\n"
            "target_mm = [0, 0, 0]\nup = [0, 1, 0]\nview_height_mm = 8.0\n[[object]]\nkind = \"opal\"\nfile = '" + vdb + "'\n",
            1);
        const int channel = rendered.image.find_channel("grain_id");
        // Grains cut by the picture's edge count half: those are seen on one more picture beside it.
        std::map<int, bool> grains;
        for (int y = 0; y < 400; ++y)
            for (int x = 0; x < 400; ++x) {
                const bool edge = x == 0 || y == 0 || x == 399 || y == 399;
                bool& touches = grains[int(rendered.image.pixel(x, y)[channel])];
                touches = touches || edge;
            }
        double seen = 0.0;
        for (const auto& [grain, touches] : grains) seen += touches ? 0.5 : 1.0;
        const double per_volume = sites / 500.0;
        const double constant = seen / 64.0 / std::pow(per_volume, 2.0 / 3.0);
        EXPECT_GT(constant, 0.80) << sites;
        EXPECT_LT(constant, 1.05) << sites;
        std::printf("%d sites: %.1f grains on 64 mm^2, %.3f n^(2/3)\n", sites, seen, constant);
    }
}

}  // namespace
}  // namespace opal
