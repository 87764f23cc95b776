// SPDX-License-Identifier: GPL-3.0-or-later
#include "timed_render.h"

#include <tbb/task_arena.h>

#include <ctime>

#include "formats/film_settings.h"
#include "formats/scene.h"
#include "renderer/host/host_scene.h"

namespace opal {

double processor_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

TimedRender timed_render(const std::string& scene_toml, int samples, int threads) {
    const SceneDescription scene = parse_scene(scene_toml, "bench.toml", {});
    TimedRender result;
    const HostScene host(scene, result.notices);
    const EmbreeScene intersector(host.meshes());
    result.reciprocal_points = host.reciprocal_points();
    Film film(scene.render.width, scene.render.height, scene.film.spectral, film_white(scene.film));
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    const double begin = processor_seconds();
    arena.execute([&] {
        result.outcome = render_picture(host, intersector, {samples, 0.0}, film, [](const RenderProgress&) {});
    });
    result.processor_s = processor_seconds() - begin;
    result.image = film.to_image();
    const double pixels = double(film.width()) * film.height();
    result.film_bytes = pixels * (sizeof(double) * film.sums_per_pixel() + sizeof(std::uint32_t)) +
                        sizeof(float) * double(result.image.pixels.size());
    return result;
}

}  // namespace opal
