// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "../formats/expect_error.h"
#include "plane_scene.h"
#include "renderer/host/checkpoint.h"
#include "small_opal.h"

namespace opal {
namespace {

void expect_same_state(const Film& a, const Film& b) {
    EXPECT_EQ(a.noise_floor(), b.noise_floor());
    EXPECT_EQ(a.to_image().pixels, b.to_image().pixels);
    for (std::uint32_t p = 0; p < std::uint32_t(a.width() * a.height()); ++p)
        ASSERT_TRUE(std::equal(a.sums(p).begin(), a.sums(p).end(), b.sums(p).begin())) << p;
    for (int i = 0; i < a.num_blocks(); ++i) {
        ASSERT_EQ(a.block(i).end_sample, b.block(i).end_sample) << i;
        ASSERT_EQ(a.block(i).settled, b.block(i).settled) << i;
        ASSERT_EQ(a.block(i).luminance_noise, b.block(i).luminance_noise) << i;
        ASSERT_EQ(a.block(i).totals.radiance, b.block(i).totals.radiance) << i;
    }
}

/// Broken off at counts before, at and between the looks at noise.
TEST(Checkpoint, ContinuesToTheSameBits) {
    const PlaneScene scene;
    const ScratchFolder folder;
    for (const double noise : {0.0, 0.08}) {
        const auto unbroken = scene.film();
        const RenderOutcome expected = scene.render(*unbroken, 120, noise);
        for (const int stop : {1, 31, 32, 33, 60, 64, 120}) {
            SCOPED_TRACE(stop);
            const auto first = scene.film();
            scene.render(*first, stop, noise);
            write_checkpoint(folder / "state", *first, {"this scene", 2.5});
            EXPECT_EQ(read_checkpoint_header(folder / "state").fingerprint, "this scene");
            EXPECT_EQ(read_checkpoint_header(folder / "state").render_s, 2.5);
            const auto second = scene.film();
            read_checkpoint(folder / "state", *second);
            expect_same_state(*first, *second);
            const RenderOutcome outcome = scene.render(*second, 120, noise);
            expect_same_state(*unbroken, *second);
            EXPECT_EQ(outcome.totals.radiance, expected.totals.radiance);
            EXPECT_EQ(outcome.totals.truncated_rgb, expected.totals.truncated_rgb);
            EXPECT_EQ(outcome.finished_samples, expected.finished_samples);
        }
    }
}

/// Stopped by the clock: soon, within a pass; every pixel tells how many samples it has, and the picture is that of those
/// samples.
TEST(Checkpoint, TimeStopsWithinAPassAndContinuesToTheSameBits) {
    const PlaneScene scene({"render.width=256", "render.height=192"});
    constexpr int samples = 40;
    const auto unbroken = scene.film();
    const RenderOutcome expected = scene.render(*unbroken, samples);
    const auto stopped = scene.film();
    const double limit_s = 0.3 * expected.seconds;
    const auto nothing = [](const RenderProgress&) {};
    const RenderOutcome part = render_picture(scene.host, scene.intersector, {samples, limit_s, 0.0}, *stopped, nothing);
    EXPECT_FALSE(part.interrupted);
    // A pass of 16 samples alone would take more than that.
    EXPECT_LT(part.seconds, limit_s + 0.1 * expected.seconds);
    EXPECT_LT(part.new_samples, expected.new_samples);
    EXPECT_GE(part.finished_samples, 1);
    const Image image = stopped->to_image();
    const int counts = image.find_channel("sample_count");
    std::uint64_t sum = 0;
    for (int b = 0; b < stopped->num_blocks(); ++b) {
        const PixelWindow window = stopped->block_window(b);
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                ASSERT_EQ(image.pixel(x, y)[counts], float(stopped->block(b).end_sample));
                sum += stopped->block(b).end_sample;
            }
    }
    EXPECT_EQ(sum, part.new_samples);
    scene.render(*stopped, samples);
    expect_same_state(*unbroken, *stopped);
    // However short the time: a whole picture.
    const auto hurried = scene.film();
    EXPECT_EQ(render_picture(scene.host, scene.intersector, {samples, 1.0e-6, 0.0}, *hurried, nothing).finished_samples, 1);
}

/// While the picture is being rendered, whatever moment is caught.
TEST(Checkpoint, WrittenWhileRenderingIsWhole) {
    const PlaneScene scene({"render.width=96", "render.height=64"});
    const ScratchFolder folder;
    const double noise = 0.05;
    const auto unbroken = scene.film();
    std::atomic<bool> ended = false;
    std::vector<std::filesystem::path> caught;
    std::thread renders([&] {
        scene.render(*unbroken, 64, noise);
        ended = true;
    });
    while (!ended && caught.size() < 12) {
        caught.push_back(folder / ("state" + std::to_string(caught.size())));
        write_checkpoint(caught.back(), *unbroken, {});
    }
    renders.join();
    std::size_t in_the_middle = 0;
    for (std::size_t i = 0; i < caught.size(); i += 1 + caught.size() / 5) {
        const auto film = scene.film();
        read_checkpoint(caught[i], *film);
        const std::uint64_t samples = film->total_samples();
        in_the_middle += samples > 0 && samples < unbroken->total_samples() ? 1 : 0;
        scene.render(*film, 64, noise);
        expect_same_state(*unbroken, *film);
    }
    EXPECT_GE(in_the_middle, 1u) << caught.size();
}

TEST(Checkpoint, DamageIsNoticed) {
    const PlaneScene scene;
    const ScratchFolder folder;
    const auto film = scene.film();
    scene.render(*film, 2);
    const std::filesystem::path path = folder / "state";
    write_checkpoint(path, *film, {"this scene", 1.0});
    std::ifstream file(path, std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(file)), {});
    const auto expect_refused = [&](const std::string& content) {
        std::ofstream(path, std::ios::binary) << content;
        const auto into = scene.film();
        EXPECT_THROW(read_checkpoint(path, *into), InputError);
    };
    for (std::size_t i = 0; i < good.size(); i += 1 + good.size() / 60) {
        std::string flipped = good;
        flipped[i] = char(flipped[i] ^ 0x20);
        expect_refused(flipped);
    }
    for (const std::size_t length : {std::size_t(0), std::size_t(5), std::size_t(40), good.size() / 2, good.size() - 1})
        expect_refused(good.substr(0, length));
    expect_refused(good + "x");
    // A damaged header is called damaged, not that of another render.
    const std::size_t header_end =
        16 + std::size_t(static_cast<unsigned char>(good[12])) + 256 * std::size_t(static_cast<unsigned char>(good[13]));
    for (std::size_t i = 16; i < header_end; ++i) {
        std::string flipped = good;
        flipped[i] = char(flipped[i] ^ 0x01);
        std::ofstream(path, std::ios::binary) << flipped;
        EXPECT_INPUT_ERROR(read_checkpoint_header(path), "it is damaged: the checksum does not fit its header");
    }
    // Another film: another size, or without spectral layers.
    std::ofstream(path, std::ios::binary) << good;
    for (const char* other : {"render.width=40", "film.spectral=false"}) {
        const auto into = PlaneScene({other}).film();
        EXPECT_THROW(read_checkpoint(path, *into), InputError) << other;
    }
}

}  // namespace
}  // namespace opal
