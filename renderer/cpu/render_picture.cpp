// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/render_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "formats/command.h"
#include "renderer/cpu/light_guides.h"
#include "renderer/host/film_noise.h"

namespace opal {
namespace {

/// Adds the next sample to each of a block's pixels. Sample by sample over the block: its totals are then added up in the same
/// order however samples are cut into passes.
template <int N>
void trace_block(const SceneView& view, const EmbreeScene& intersector, const PixelWindow& pixels, Film& film, FilmBlock& block) {
    const PixelWindow& window = film.window();
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            // A path's random numbers belong to its pixel of the whole picture, so that a part of it shows the same.
            const std::uint32_t pixel = std::uint32_t(window.y0 + y) * std::uint32_t(view.width) + std::uint32_t(window.x0 + x);
            PathWavelengths<N> wavelengths;
            const PathResult<N> result = trace_sample(view, intersector, pixel, block.end_sample, wavelengths, block.counters);
            film.add(view.spectra, std::uint32_t(y * film.width() + x), film_sample(wavelengths, result), block.totals);
        }
    ++block.end_sample;
}

using BlockTracer = decltype(&trace_block<1>);

/// The transport compiled for just as many lanes as are wanted.
BlockTracer block_tracer(int wavelengths) {
    if (wavelengths == 1) return trace_block<1>;
    return wavelengths <= 4 ? trace_block<4> : trace_block<8>;
}

/// Remembers a block's noise, which ends it where it is small enough.
void look_at_noise(Film& film, int index, double wanted) {
    FilmBlock& block = film.block(index);
    const NoiseLevel noise = block_noise(film, index);
    block.luminance_noise = float(noise.luminance);
    block.chroma_noise = float(noise.chroma);
    if (wanted > 0.0 && noise.larger() <= wanted) block.settled = true;
}

/// Samples of the next pass: few at first, so that a picture is there early, then more, to keep the film's memory traffic low; no
/// more than the time that is left allows. `done` samples per pixel are there, `new_samples` of them drawn in `elapsed_s`.
std::uint32_t pass_size(std::uint32_t done, std::uint32_t new_samples, double elapsed_s, double time_limit_s) {
    const std::uint32_t size = done < 4 ? 1 : (done < 16 ? 4 : 16);
    if (time_limit_s <= 0.0 || new_samples == 0) return size;
    const double affordable = (time_limit_s - elapsed_s) * new_samples / std::max(1.0e-3, elapsed_s);
    return std::uint32_t(std::clamp(affordable, 1.0, double(size)));
}

/// One render: what it works on, and how far it has come.
class RenderRun {
  public:
    RenderRun(const HostScene& scene, const EmbreeScene& intersector, const RenderLimits& limits, Film& film,
              const std::function<void(const RenderProgress&)>& progress, const MakeDevice& make_device)
        : guides_(scene, intersector),
          device_(make_device ? make_device(guides_.scene(), film) : nullptr),
          intersector_(intersector),
          limits_(limits),
          film_(film),
          progress_(progress),
          trace_(block_tracer(scene.view().wavelengths)),
          // What single samples not in whole groups would tell about noise depends on where they start.
          groups_whole_(film.first_sample() % noise_group == 0) {
        for (int b = 0; b < film.num_blocks(); ++b) total_work_ += work_left(film.block(b));
    }

    RenderOutcome run() {
        const std::uint32_t start = least_end();
        const std::uint64_t samples_before = film_.total_samples();
        RenderOutcome outcome;
        begin_noise();
        while (!interrupt_requested()) {
            const std::uint32_t done = least_end();
            if (done >= std::uint32_t(limits_.samples)) break;
            whole_ = done > film_.first_sample();
            if (stops()) break;
            const std::uint32_t target = next_target(done, done - start);
            if (device_)
                device_pass(target);
            else
                pass(target);
            begin_noise();
        }
        outcome.interrupted = interrupt_requested();
        std::uint32_t lowest = UINT32_MAX;
        // In the order of blocks: floating-point sums must not depend on which thread ended first.
        for (int b = 0; b < film_.num_blocks(); ++b) {
            const FilmBlock& block = film_.block(b);
            outcome.counters.add(block.counters);
            outcome.totals.add(block.totals);
            lowest = std::min(lowest, block.end_sample - film_.first_sample());
        }
        outcome.finished_samples = int(lowest);
        outcome.new_samples = film_.total_samples() - samples_before;
        outcome.seconds = watch_.seconds();
        if (device_) outcome.devices = device_->names();
        if (device_) outcome.device_seconds = device_->kernel_seconds();
        return outcome;
    }

  private:
    /// Whether to stop where one is, between two samples of a block: on request at once; for the time once there is a whole
    /// picture.
    bool stops() const { return interrupt_requested() || (whole_ && limits_.time_s > 0.0 && watch_.seconds() >= limits_.time_s); }

    std::int64_t work_left(const FilmBlock& block) const {
        return block.settled ? 0 : std::max<std::int64_t>(0, std::int64_t(limits_.samples) - block.end_sample);
    }

    /// Of the blocks that go on; limits_.samples where none does.
    std::uint32_t least_end() const {
        std::uint32_t least = std::uint32_t(limits_.samples);
        for (int b = 0; b < film_.num_blocks(); ++b)
            if (!film_.block(b).settled) least = std::min(least, film_.block(b).end_sample);
        return least;
    }

    std::uint32_t next_target(std::uint32_t done, std::uint32_t new_samples) const {
        const std::uint32_t first = film_.first_sample();
        std::uint32_t target = done + pass_size(done - first, new_samples, watch_.seconds(), limits_.time_s);
        // The floor of the noise is of the whole picture at one sample count.
        if (done < first + least_samples_for_noise) target = std::min(target, first + least_samples_for_noise);
        return std::min(target, std::uint32_t(limits_.samples));
    }

    void pass(std::uint32_t target) {
        tbb::parallel_for(tbb::blocked_range<int>(0, film_.num_blocks(), 1), [&](const tbb::blocked_range<int>& range) {
            for (int b = range.begin(); b != range.end() && !stops(); ++b) {
                advance(b, target);
                report_progress();
            }
        });
    }

    void report_progress() {
        const double by_time = limits_.time_s > 0.0 ? watch_.seconds() / limits_.time_s : 0.0;
        progress_({std::min(1.0, std::max(double(work_done_) / double(total_work_), by_time)),
                   double(new_paths_) / std::max(1.0e-3, watch_.seconds())});
    }

    /// The same on a device: launch after launch of the blocks that are farthest behind, each up to where noise is looked at
    /// next.
    void device_pass(std::uint32_t target) {
        while (!stops()) {
            std::uint32_t behind = target;
            for (int b = 0; b < film_.num_blocks(); ++b)
                if (!film_.block(b).settled) behind = std::min(behind, film_.block(b).end_sample);
            if (behind == target) return;
            std::vector<int> blocks;
            for (int b = 0; b < film_.num_blocks(); ++b)
                if (!film_.block(b).settled && film_.block(b).end_sample == behind) blocks.push_back(b);
            const std::uint32_t first = film_.first_sample(), look = first + next_noise_look(behind - first);
            device_->advance(film_, blocks, std::min(target, look) - behind);
            for (const int b : blocks) finish_launch(b, behind, look);
            report_progress();
        }
    }

    void finish_launch(int index, std::uint32_t samples_before, std::uint32_t look) {
        FilmBlock& block = film_.block(index);
        const std::scoped_lock lock(block.lock);
        const PixelWindow window = film_.block_window(index);
        new_paths_ += std::int64_t(block.end_sample - samples_before) * window.width() * window.height();
        const std::int64_t left = work_left(block);
        if (block.end_sample == look && film_.noise_floor() >= 0.0) look_at_noise(film_, index, limits_.noise);
        work_done_ += std::int64_t(block.end_sample - samples_before) + left - work_left(block);
    }

    /// Once all blocks have as many samples as noise takes: its floor, and the first look at it. A render that was cut off in
    /// between makes up for what it missed.
    void begin_noise() {
        const std::uint32_t begin = film_.first_sample() + least_samples_for_noise;
        if (!groups_whole_ || (film_.noise_floor() < 0.0 && least_end() != begin)) return;
        if (film_.noise_floor() < 0.0) film_.set_noise_floor(measured_noise_floor(film_));
        for (int b = 0; b < film_.num_blocks(); ++b) {
            FilmBlock& block = film_.block(b);
            const std::scoped_lock lock(block.lock);
            if (block.end_sample != begin || block.luminance_noise >= 0.0f) continue;
            const std::int64_t work_before = work_left(block);
            look_at_noise(film_, b, limits_.noise);
            work_done_ += work_before - work_left(block);
        }
    }

    void advance(int index, std::uint32_t target) {
        FilmBlock& block = film_.block(index);
        const std::scoped_lock lock(block.lock);
        const std::int64_t work_before = work_left(block);
        const std::uint32_t samples_before = block.end_sample;
        while (!block.settled && block.end_sample < target && !stops()) {
            const std::uint32_t first = film_.first_sample(), look = first + next_noise_look(block.end_sample - first);
            trace_(guides_.scene(), intersector_, film_.block_window(index), film_, block);
            if (block.end_sample == look && film_.noise_floor() >= 0.0) look_at_noise(film_, index, limits_.noise);
        }
        const PixelWindow window = film_.block_window(index);
        new_paths_ += std::int64_t(block.end_sample - samples_before) * window.width() * window.height();
        work_done_ += work_before - work_left(block);
    }

    const LightGuides guides_;
    const std::unique_ptr<PathDevice> device_;
    const EmbreeScene& intersector_;
    const RenderLimits limits_;
    Film& film_;
    const std::function<void(const RenderProgress&)>& progress_;
    const BlockTracer trace_;
    const bool groups_whole_;
    const Stopwatch watch_;
    bool whole_ = false;  ///< every pixel has a sample
    std::int64_t total_work_ = 0;
    std::atomic<std::int64_t> work_done_ = 0;
    std::atomic<std::int64_t> new_paths_ = 0;
};

}  // namespace

RenderOutcome render_picture(const HostScene& scene, const EmbreeScene& intersector, const RenderLimits& limits, Film& film,
                             const std::function<void(const RenderProgress&)>& progress, const MakeDevice& make_device) {
    return RenderRun(scene, intersector, limits, film, progress, make_device).run();
}

}  // namespace opal
