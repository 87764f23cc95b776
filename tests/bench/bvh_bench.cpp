// SPDX-License-Identifier: GPL-3.0-or-later
#include "bvh_bench.h"

#include <fmt/format.h>

#include <fstream>

#include "bvh_comparison.h"
#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"

namespace opal {
namespace {

/// Per ray, over rays made beforehand.
template <class Intersector>
double closest_ns(const Intersector& intersector, const std::vector<Ray>& rays) {
    const Stopwatch watch;
    std::uint64_t met = 0;
    for (const Ray& ray : rays) {
        RayHit hit;
        met += intersector.closest(ray, hit) ? 1 : 0;
    }
    const double seconds = watch.seconds();
    if (met == 0) throw SystemError("no ray met anything");
    return 1.0e9 * seconds / double(rays.size());
}

std::string row(const ComparedScene& scene, std::uint64_t count) {
    const Bvh bvh(scene.meshes);
    const std::vector<MeshView> views = views_of(scene.meshes);
    const BvhView<true> view = bvh.view<true>(views.data());
    const EmbreeScene embree(scene.meshes);
    const BvhComparison result = compare_with_embree(scene, view, embree, 0, count);
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, scene.exact ? 50'000 : 500'000); ++i)
        rays.push_back(compared_ray(scene, RayKind(i % num_ray_kinds), i));
    const double ours_ns = closest_ns(view, rays), embree_ns = closest_ns(embree, rays);
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3g},{:.4g},{:.4g}\n", scene.name, bvh.primitives().size(),
                       bvh.depth(), result.rays, result.met, result.same, result.same_bits, result.ties, result.at_border,
                       result.edge_on, result.at_start, result.unexplained, result.wrong_occlusion, result.largest_share, ours_ns,
                       embree_ns);
}

}  // namespace

void bench_bvh(const std::filesystem::path& folder, std::uint64_t rays) {
    std::filesystem::create_directories(folder);
    AtomicFile file(folder / "bvh.csv");
    std::ofstream csv(file.temporary_path());
    csv << "scene,primitives,levels,rays,met,same,same_bits,ties,at_border,edge_on,at_start,unexplained,wrong_occlusion,"
           "largest_share_of_tolerance,ns_per_ray,embree_ns_per_ray\n";
    // A ray against patches takes a hundred times as long as one against triangles.
    const std::vector<ComparedScene> scenes = compared_scenes();
    const std::uint64_t exact_rays = rays / 50;
    for (const ComparedScene& scene : scenes)
        csv << row(scene, scene.exact ? exact_rays : (rays - exact_rays) / (scenes.size() - 1)) << std::flush;
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", (folder / "bvh.csv").string()));
    file.commit();
}

}  // namespace opal
