// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <thread>

#include "formats/error.h"
#include "plane_scene.h"
#include "renderer/cpu/loop_device.h"
#include "renderer/host/checkpoint.h"
#include "renderer/host/device_room.h"
#include "renderer/host/several_devices.h"
#include "same_film.h"
#include "small_opal.h"

namespace opal {
namespace {

/// A device's loop that waits before each launch, or fails, and has a clock that stands still.
class SlowLoop : public PathDevice {
  public:
    SlowLoop(std::unique_ptr<PathDevice> loop, int wait_ms) : loop_(std::move(loop)), wait_ms_(wait_ms) {}

    std::vector<std::string> names() const override { return {"loop of " + std::to_string(wait_ms_) + " ms"}; }
    std::optional<KernelSeconds> kernel_seconds() const override { return KernelSeconds{1.0 * wait_ms_, 0.25}; }
    void advance(Film& film, std::span<const int> blocks, std::uint32_t samples) override {
        if (wait_ms_ < 0) throw SystemError("fell off the bus");
        std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms_));
        loop_->advance(film, blocks, samples);
    }

  private:
    std::unique_ptr<PathDevice> loop_;
    int wait_ms_;
};

/// Loops, one for each of the waits (ms).
MakeDevice loops(const PlaneScene& scene, std::vector<int> waits_ms) {
    return [&scene, waits_ms](const SceneView& view, const Film& film) {
        std::vector<std::unique_ptr<PathDevice>> devices;
        for (const int wait_ms : waits_ms)
            devices.push_back(
                std::make_unique<SlowLoop>(std::make_unique<LoopDevice>(view, Bvh(scene.host.meshes()), film), wait_ms));
        return std::make_unique<SeveralDevices>(std::move(devices));
    };
}

RenderOutcome render(const PlaneScene& scene, Film& film, int samples, double noise, const MakeDevice& make) {
    return render_picture(
        scene.host, scene.intersector, {samples, 0.0, noise}, film, [](const RenderProgress&) {}, make);
}

/// One device alone, without SeveralDevices.
MakeDevice one_loop(const PlaneScene& scene) {
    return [&scene](const SceneView& view, const Film& film) {
        return std::make_unique<LoopDevice>(view, Bvh(scene.host.meshes()), film);
    };
}

/// Sums of 100 numbers in another order: far below this, as a sample lost or counted twice is far above.
constexpr double rounding = 1.0e-12;

TEST(SeveralDevices, AddUpToWhatOneDraws) {
    const PlaneScene scene;
    for (const double noise : {0.0, 0.08}) {
        const auto one = scene.film();
        render(scene, *one, 100, noise, one_loop(scene));
        int settled = 0;
        for (int b = 0; b < one->num_blocks(); ++b) settled += one->block(b).settled ? 1 : 0;
        EXPECT_EQ(settled > 0, noise > 0.0);
        for (const std::size_t count : {2, 3}) {
            SCOPED_TRACE(count);
            const auto several = scene.film();
            const RenderOutcome outcome = render(scene, *several, 100, noise, loops(scene, std::vector<int>(count)));
            expect_same_film(*one, *several, rounding);
            EXPECT_NEAR(one->noise_floor(), several->noise_floor(), rounding * one->noise_floor());
            EXPECT_EQ(outcome.devices.size(), count);
        }
    }
}

TEST(SeveralDevices, SameBitsWhicheverEndsFirst) {
    const PlaneScene scene;
    const auto first = scene.film(), second = scene.film();
    const RenderOutcome outcome = render(scene, *first, 40, 0.0, loops(scene, {0, 2, 5}));
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        render(scene, *second, 40, 0.0, loops(scene, {5, 2, 0}));
    }
    expect_same_film(*first, *second, 0.0);
    EXPECT_EQ(outcome.devices, (std::vector<std::string>{"loop of 0 ms", "loop of 2 ms", "loop of 5 ms"}));
    ASSERT_TRUE(outcome.device_seconds);
    EXPECT_EQ(outcome.device_seconds->trace, 7.0);
    EXPECT_EQ(outcome.device_seconds->add, 0.75);
    const auto by_cores = scene.film();
    EXPECT_TRUE(scene.render(*by_cores, 1).devices.empty());
}

/// Broken off between two launches to the same bits; elsewhere, launches are cut at other places.
TEST(SeveralDevices, ContinueFromACheckpoint) {
    const PlaneScene scene;
    const ScratchFolder folder;
    const auto unbroken = scene.film();
    render(scene, *unbroken, 100, 0.08, loops(scene, {0, 0}));
    for (const int stop : {33, 64}) {
        SCOPED_TRACE(stop);
        const auto first = scene.film(), second = scene.film();
        render(scene, *first, stop, 0.08, loops(scene, {0, 0}));
        write_checkpoint(folder / "state", *first, {"this scene", 1.0});
        read_checkpoint(folder / "state", *second);
        render(scene, *second, 100, 0.08, loops(scene, {0, 0}));
        expect_same_film(*unbroken, *second, stop == 64 ? 0.0 : rounding);
    }
}

TEST(SeveralDevices, WhatOneThrowsIsThrown) {
    const PlaneScene scene;
    const auto film = scene.film();
    EXPECT_THROW(render(scene, *film, 40, 0.0, loops(scene, {0, -1})), SystemError);
}

/// The very code that says of a CUDA device what needs how much.
TEST(DeviceRoom, WhatNeedsHowMuchIsSaidBeforeAnythingIsDrawn) {
    const PlaneScene scene;
    const auto film = scene.film();
    const Bvh bvh(scene.host.meshes());
    const SceneMemory needed = device_memory(scene.host.view(), bvh, *film);
    const auto render_with = [&](std::size_t memory_bytes) {
        return render(scene, *film, 1, 0.0, [&](const SceneView& view, const Film& target) {
            return std::make_unique<LoopDevice>(view, bvh, target, memory_bytes);
        });
    };
    std::string message;
    try {
        render_with(needed.total_bytes() - 1);
    } catch (const SystemError& error) {
        message = error.what();
    }
    EXPECT_EQ(film->total_samples(), 0u);
    const std::string total = fmt::format("{:.3g} GB", 1.0e-9 * double(needed.total_bytes()));
    EXPECT_EQ(message.find("the scene needs " + total + " of the memory of a device's loop on the processor, of which " + total +
                           " are free: tables "),
              0u)
        << message;
    for (const char* item : {", environment ", ", meshes ", ", materials ", ", tree of rays "})
        EXPECT_NE(message.find(item), std::string::npos) << item << message;
    // 36 x 20 pixels of 60 sums and a count; 15 blocks of 51 totals' numbers and some.
    EXPECT_NE(message.find(", film 0.37"), std::string::npos) << message;
    EXPECT_NE(message.find(", paths under way 1.07 GB"), std::string::npos) << message;

    EXPECT_NO_THROW(render_with(needed.total_bytes()));
    EXPECT_EQ(film->total_samples(), 36u * 20u);

    // What it says of the scene is what a copy of it takes.
    HostArrayCopier arrays;
    copied_scene(scene.host.view(), arrays);
    std::size_t of_scene = 0;
    for (const SceneMemory::Item& item : needed.items)
        if (item.what != "tree of rays" && item.what != "film" && item.what != "paths under way") of_scene += item.bytes;
    EXPECT_EQ(of_scene, arrays.total_bytes());
}

}  // namespace
}  // namespace opal
