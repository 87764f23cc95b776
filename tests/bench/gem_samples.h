// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "formats/colorimetry.h"
#include "renderer/core/path_tracer.h"
#include "renderer/cpu/embree_scene.h"

/// Single samples of the pixels that show a gem: what benches of convergence look at.
namespace opal {

/// Luminance and two opponent colours, X and Z against Y over the white's.
using Opponent = std::array<double, 3>;

inline Opponent opponent_of(Xyz color) {
    return {color.y, color.x / srgb_white.x - color.y, color.z / srgb_white.z - color.y};
}

template <int N>
inline Opponent trace_opponent(const SceneView& view, const EmbreeScene& intersector, std::uint32_t pixel, std::uint32_t sample,
                               PathCounters& counters) {
    PathWavelengths<N> wavelengths;
    const PathResult<N> result = trace_sample(view, intersector, pixel, sample, wavelengths, counters);
    Xyz sum{0.0, 0.0, 0.0};
    for (int i = 0; i < wavelengths.count; ++i) {
        const Vec3 observer = table_at(view.spectra.observer, wavelengths.wavelength_nm[i]);
        const double radiance = double(result.radiance.v[i]) / (double(wavelengths.pdf_per_nm[i]) * wavelengths.count);
        sum = {sum.x + radiance * double(observer.x), sum.y + radiance * double(observer.y),
               sum.z + radiance * double(observer.z)};
    }
    return opponent_of(sum);
}

/// The pixels whose centre shows a transparent body.
inline std::vector<std::uint32_t> gem_pixels(const SceneView& view, const EmbreeScene& intersector) {
    std::vector<std::uint32_t> pixels;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            RayHit hit;
            const Ray ray = camera_ray(view.camera, (float(x) + 0.5f) / float(view.width), (float(y) + 0.5f) / float(view.height),
                                       0.0f, 0.0f);
            if (intersector.closest(ray, hit) && view.meshes[hit.mesh].body >= 0)
                pixels.push_back(std::uint32_t(y * view.width + x));
        }
    return pixels;
}

}  // namespace opal
