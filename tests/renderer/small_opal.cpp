// SPDX-License-Identifier: Apache-2.0
#include "small_opal.h"

#include <openvdb/tools/LevelSetPlatonic.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <unistd.h>

#include <cmath>

#include "backends.h"
#include "formats/film_settings.h"
#include "formats/random.h"
#include "formats/scene.h"
#include "renderer/cpu/aovs.h"

namespace opal {

SmallOpal::SmallOpal() {
    constants.sigma_a_per_mm = absorber_spectrum("neutral", 0.0);
}

OpalAsset SmallOpal::make() const {
    initialize_openvdb();
    OpalAsset asset;
    asset.constants = constants;
    const double half_z = half_thickness_mm > 0.0 ? half_thickness_mm : radius_mm;
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel_mm);
    if (half_thickness_mm > 0.0)
        asset.shape = openvdb::tools::createLevelSetBox<openvdb::FloatGrid>(
            openvdb::math::BBox<openvdb::Vec3f>({float(-radius_mm), float(-radius_mm), float(-half_z)},
                                                {float(radius_mm), float(radius_mm), float(half_z)}),
            *transform);
    else
        asset.shape =
            openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(float(radius_mm), openvdb::Vec3f(0.0f), float(voxel_mm));

    for (int g = 1; g <= grains; ++g) {
        const RandomBlock a = random_block(11, RandomStream::site_candidates, std::uint64_t(g), 0);
        const RandomBlock b = random_block(11, RandomStream::site_candidates, std::uint64_t(g), 1);
        Site site;
        site.position_mm = {radius_mm * (2.0 * uniform_double(a.value[0], a.value[1]) - 1.0),
                            radius_mm * (2.0 * uniform_double(a.value[2], a.value[3]) - 1.0),
                            half_z * (2.0 * uniform_double(b.value[0], b.value[1]) - 1.0)};
        site.grain = g;
        asset.sites.push_back(site);
        asset.grain_orientations.push_back(random_orientation(5, false, std::uint64_t(g)));
    }

    asset.grain_id = openvdb::Int32Grid::create(0);
    asset.grain_id->setTransform(transform);
    auto ids = asset.grain_id->getAccessor();
    const int reach = int(radius_mm / voxel_mm) + 1, reach_z = int(half_z / voxel_mm) + 1;
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
            for (int k = -reach_z; k <= reach_z; ++k) {
                const openvdb::Vec3d p = voxel_mm * openvdb::Vec3d(i, j, k);
                const bool inside = half_thickness_mm > 0.0
                                        ? std::abs(p.x()) < radius_mm && std::abs(p.y()) < radius_mm && std::abs(p.z()) < half_z
                                        : p.length() < radius_mm;
                if (!inside) continue;
                std::int32_t nearest = 1;
                for (int g = 2; g <= grains; ++g)
                    if ((asset.sites[std::size_t(g) - 1].position_mm - p).lengthSqr() <
                        (asset.sites[std::size_t(nearest) - 1].position_mm - p).lengthSqr())
                        nearest = g;
                ids.setValueOn({i, j, k}, nearest);
            }
    asset.grain_id->pruneGrid();

    const openvdb::Vec3d corner(radius_mm + 2.0 * field_voxel_mm, radius_mm + 2.0 * field_voxel_mm,
                                half_z + 2.0 * field_voxel_mm);
    openvdb::FloatGrid::Ptr* grids[] = {&asset.sigma_a_scale, &asset.sigma_s_rayleigh_400nm, &asset.sigma_s_mie};
    for (std::size_t f = 0; f < fields.size(); ++f)
        if (fields[f]) *grids[f] = box_field({-corner, corner}, field_voxel_mm, fields[f]);
    return asset;
}

openvdb::FloatGrid::Ptr box_field(const openvdb::BBoxd& box_mm, double voxel_mm,
                                  const std::function<double(const openvdb::Vec3d&)>& value) {
    initialize_openvdb();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_mm));
    auto accessor = grid->getAccessor();
    const openvdb::CoordBBox voxels(openvdb::Coord::ceil(box_mm.min() / voxel_mm),
                                    openvdb::Coord::floor(box_mm.max() / voxel_mm));
    for (auto voxel = voxels.begin(); voxel; ++voxel) accessor.setValueOn(*voxel, float(value(voxel_mm * (*voxel).asVec3d())));
    return grid;
}

ScratchFolder::ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "opal_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

Rendered render_text(const std::string& scene_toml, int samples, const char* backend) {
    const SceneDescription scene = parse_scene(scene_toml, "test.toml", {});
    std::vector<std::string> notices;
    const HostScene host(scene, notices);
    const EmbreeScene intersector(host.meshes());
    Film film(scene.render.window(), scene.render.width, scene.render.height, scene.film.spectral, film_white(scene.film));
    Rendered rendered;
    rendered.outcome = render_picture(
        host, intersector, {samples, 0.0}, film, [](const RenderProgress&) {}, backend_maker(backend, host.meshes()));
    rendered.image = film.to_image();
    add_aovs(host, intersector, scene.film.aovs, rendered.image);
    return rendered;
}

MeanEstimate region_mean(const Image& image, const std::string& channel, int x0, int y0, int x1, int y1) {
    const int mean_channel = image.find_channel(channel), variance_channel = image.find_channel("variance." + channel);
    double sum = 0.0, variance = 0.0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            sum += double(image.pixel(x, y)[mean_channel]);
            if (variance_channel >= 0) variance += double(image.pixel(x, y)[variance_channel]);
        }
    const double n = double(x1 - x0) * (y1 - y0);
    return {sum / n, std::sqrt(variance) / n};
}

}  // namespace opal
