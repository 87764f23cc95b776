// SPDX-License-Identifier: GPL-3.0-or-later
#include "timed_render.h"

#include <tbb/task_arena.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

#include "formats/film_settings.h"
#include "formats/scene.h"
#include "renderer/host/host_scene.h"

namespace opal {
namespace {

double resident_bytes() {
    std::ifstream file("/proc/self/statm");
    double pages = 0.0, resident = 0.0;
    file >> pages >> resident;
    return resident * double(::sysconf(_SC_PAGESIZE));
}

}  // namespace

double processor_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

TimedRender timed_render(const std::string& scene_toml, int samples, int threads) {
    const SceneDescription scene = parse_scene(scene_toml, "bench.toml", {});
    std::vector<std::string> notices;
    const HostScene host(scene, notices);
    const EmbreeScene intersector(host.meshes());
    TimedRender result;
    result.reciprocal_points = host.reciprocal_points();
    const double before_bytes = resident_bytes();
    Film film(scene.render.width, scene.render.height, scene.film.spectral, film_white(scene.film));
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    const double begin = processor_seconds();
    arena.execute([&] { result.outcome = render_cpu(host, intersector, {samples, 0.0}, film, [](const RenderProgress&) {}); });
    result.processor_s = processor_seconds() - begin;
    result.image = film.to_image();
    result.grown_bytes = resident_bytes() - before_bytes;
    return result;
}

}  // namespace opal
