// SPDX-License-Identifier: GPL-3.0-or-later
#include "subject.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <time.h>

#include <atomic>
#include <cmath>

#include "renderer/host/scene_copy.h"

namespace opal {
namespace {

double thread_processor_s() {
    timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Turned like the scene's own environment.
EnvironmentMap tent_of(EnvironmentDescription environment, Upsampling upsampling) {
    environment.kind = EnvironmentKind::tent;
    environment.file.clear();
    return make_environment(environment, upsampling);
}

}  // namespace

Subject::Subject(const std::filesystem::path& scene, const std::vector<std::string>& settings, SpectralChoice spectral,
                 Tracing tracing)
    : description_(read_scene(scene, settings)),
      host_(description_, notices_),
      intersector_(host_.meshes()),
      tree_(tracing == Tracing::embree ? std::nullopt : std::optional<Bvh>(host_.meshes())),
      guides_(host_, intersector_),
      lines_(host_.view().spectra, spectral),
      load_s_(watch_.seconds()),
      tent_(tent_of(description_.environment, description_.color.upsampling)) {}

std::size_t Subject::memory_bytes() const {
    return scene_memory(guides_.scene()).total_bytes();
}

template <int N, class Intersector>
Opponent Subject::mean_of_pixel(const SceneView& view, const Intersector& intersector, std::uint32_t pixel, int samples) const {
    Opponent mean = {};
    PathCounters counters;
    for (int sample = 0; sample < samples; ++sample) {
        PathWavelengths<N> wavelengths;
        const PathResult<N> result = trace_sample(view, intersector, pixel, std::uint32_t(sample), wavelengths, counters);
        Xyz sum{0.0, 0.0, 0.0};
        for (int i = 0; i < wavelengths.count; ++i) {
            const Xyz color = lines_.color(view.spectra, wavelengths.wavelength_nm[i], wavelengths.pdf_per_nm[i]);
            const double radiance = double(result.radiance.v[i]) / wavelengths.count;
            sum = {sum.x + radiance * color.x, sum.y + radiance * color.y, sum.z + radiance * color.z};
        }
        const Opponent found = opponent_of(sum);
        for (std::size_t c = 0; c < 3; ++c) mean[c] += found[c] / samples;
    }
    return mean;
}

template <int N>
void Subject::draw_lanes(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed, Lighting lighting) {
    SceneView view = guides_.scene();
    view.seed = seed;
    if (lighting == Lighting::tent) {
        view.environment = tent_.view();
        view.lights.environment_luminance = tent_.mean_luminance;
    }
    lines_.confine(view.spectra);
    const BvhView<true> tree = tree_ ? tree_->view<true>(view.meshes) : BvhView<true>();
    std::vector<Opponent> means(pixels.size());
    std::atomic<double> processor_s = 0.0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 4), [&](const tbb::blocked_range<std::size_t>& range) {
        const double begin_s = thread_processor_s();
        for (std::size_t p = range.begin(); p < range.end(); ++p)
            means[p] = tree_ ? mean_of_pixel<N>(view, tree, pixels[p], samples)
                             : mean_of_pixel<N>(view, intersector_, pixels[p], samples);
        processor_s += thread_processor_s() - begin_s;
    });
    keep(std::move(means), processor_s / double(pixels.size()) / samples, lighting);
}

void Subject::draw(const std::vector<std::uint32_t>& pixels, int samples, std::uint64_t seed, Lighting lighting) {
    const int lanes = host_.view().wavelengths;
    if (lanes == 1)
        draw_lanes<1>(pixels, samples, seed, lighting);
    else if (lanes <= 4)
        draw_lanes<4>(pixels, samples, seed, lighting);
    else
        draw_lanes<8>(pixels, samples, seed, lighting);
}

Estimate mean_of(const std::vector<double>& values) {
    Estimate estimate;
    for (const double value : values) estimate.value += value / double(values.size());
    double square = 0.0;
    for (const double value : values) square += (value - estimate.value) * (value - estimate.value);
    estimate.standard_error = std::sqrt(square / double(values.size()) / double(values.size() - 1));
    return estimate;
}

}  // namespace opal
