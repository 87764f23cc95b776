// SPDX-License-Identifier: GPL-3.0-or-later
#include "media_bench.h"

#include <fmt/format.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/command.h"
#include "renderer/core/medium_flight.h"
#include "renderer/host/medium_fields.h"

namespace opal {
namespace {

constexpr float radius_mm = 3.0f;
constexpr double seconds_per_row = 0.2;
using FieldFunction = std::function<double(const openvdb::Vec3d&)>;

double waves(const openvdb::Vec3d& p) {
    return std::sin(2.0 * p.x() + 1.0) * std::sin(1.7 * p.y() + 0.5) * std::cos(2.3 * p.z());
}

double layers(const openvdb::Vec3d& p) {
    return std::sin(6.0 * p.z());
}

/// Mostly clear with dense spots: -1 (factor 0 at contrast 1) in nine tenths of the volume.
double clouds(const openvdb::Vec3d& p) {
    return 40.0 * std::max(0.0, waves(p) - 0.5) - 1.0;
}

openvdb::FloatGrid::Ptr filled(double coefficient, double contrast, const FieldFunction& factor) {
    constexpr double voxel_mm = 0.1;
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_mm));
    auto accessor = grid->getAccessor();
    const openvdb::CoordBBox voxels(openvdb::Coord(-33), openvdb::Coord(33));
    for (auto voxel = voxels.begin(); voxel; ++voxel)
        accessor.setValueOn(*voxel, float(coefficient * (1.0 + contrast * factor(voxel_mm * (*voxel).asVec3d()))));
    return grid;
}

/// Chord number `index` of the ball, in a direction and at a distance from the middle of its own.
Ray chord(std::uint64_t index, float& length_mm) {
    const RandomBlock block = random_block(1, RandomStream::bench, index, 0);
    const float z = 2.0f * uniform_float(block.value[0]) - 1.0f, azimuth = 2.0f * pi_f * uniform_float(block.value[1]);
    const float sine = std::sqrt(1.0f - z * z);
    const Vec3 direction{sine * std::cos(azimuth), sine * std::sin(azimuth), z};
    const float offset = 0.95f * radius_mm * std::sqrt(uniform_float(block.value[2]));
    const float turn = 2.0f * pi_f * uniform_float(block.value[3]);
    const Frame frame(direction);
    const float half_mm = std::sqrt(radius_mm * radius_mm - offset * offset);
    length_mm = 2.0f * half_mm;
    return {offset * (std::cos(turn) * frame.tangent + std::sin(turn) * frame.bitangent) - half_mm * direction, direction};
}

/// Mean over the lanes of what passes one flight.
double fly(const OpalView& opal, const LaneMedium<4>& medium, const Ray& ray, float length_mm, PathRandom& random) {
    LaneWeights<4> weights;
    std::uint64_t violations = 0;
    MediumFlight<4> flight(opal, medium, ray, weights, random, violations);
    flight.advance(length_mm, weights);
    if (flight.scattered()) return 0.0;
    const Lanes<4> contribution = weights.contribution();
    return 0.25 * double(contribution.v[0] + contribution.v[1] + contribution.v[2] + contribution.v[3]);
}

class MediaBench {
  public:
    std::vector<MediaBenchRow> run() {
        for (const char* medium : {"absorption", "body"}) {
            for (const double contrast : {0.1, 0.3, 0.5, 0.7, 0.9}) compare(medium, "waves", waves, contrast);
            for (const double contrast : {0.1, 0.5, 0.9}) compare(medium, "layers", layers, contrast);
            compare(medium, "clouds", clouds, 1.0);
        }
        return std::move(rows_);
    }

  private:
    void compare(const std::string& medium, const std::string& name, const FieldFunction& factor, double contrast) {
        OpalAsset asset;
        asset.shape = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius_mm, openvdb::Vec3f(0.0f), 0.1f);
        asset.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.5);
        asset.sigma_a_scale = filled(1.0, contrast, factor);
        if (medium == "body") asset.sigma_s_mie = filled(0.5, contrast, factor);
        const MediumFields fields(asset, MajorantKind::local, 1.0, "bench");
        OpalView opal;
        fields.attach(opal.medium);
        LaneMedium<4> lanes;
        for (int i = 0; i < 4; ++i) {
            lanes.sigma_a.v[i] = float(asset.constants.sigma_a_per_mm.at(450.0 + 75.0 * i));
            lanes.sigma_mie.v[i] = medium == "body" ? 1.0f : 0.0f;
        }
        const MediumFieldGrids grids = {fit_field(*asset.sigma_a_scale, *asset.shape), nullptr,
                                        asset.sigma_s_mie ? fit_field(*asset.sigma_s_mie, *asset.shape) : nullptr};
        const openvdb::BBoxd bounds(openvdb::Vec3d(-3.3), openvdb::Vec3d(3.3));
        MediaBenchRow row{medium, name, contrast, "residual", 1, false, 0.0, 0.0};
        for (row.cells = 1; row.cells <= 64; row.cells *= 2)
            for (const char* method : {"residual", "ratio"}) {
                row.method = method;
                measure(opal, lanes, grids, MajorantGrid(grids, bounds, row.cells), row);
            }
        row.fitted = true;
        const MajorantView fitted = fields.majorants()->view();
        row.cells = std::max({fitted.size[0], fitted.size[1], fitted.size[2]});
        for (const char* method : {"residual", "ratio"}) {
            row.method = method;
            measure(opal, lanes, grids, *fields.majorants(), row);
        }
    }

    void measure(OpalView opal, const LaneMedium<4>& lanes, const MediumFieldGrids& grids, const MajorantGrid& majorants,
                 MediaBenchRow row) {
        const MajorantGrid grid = row.method == "ratio" ? majorants.without_least(grids) : majorants;
        opal.medium.majorants = grid.view();
        double squares = 0.0;
        std::uint64_t pairs = 0;
        const Stopwatch watch;
        do {
            for (int k = 0; k < 1000; ++k, ++pairs) {
                float length_mm = 0.0f;
                const Ray ray = chord(pairs, length_mm);
                PathRandom first(1, 0, std::uint32_t(pairs)), second(1, 1, std::uint32_t(pairs));
                const double difference = fly(opal, lanes, ray, length_mm, first) - fly(opal, lanes, ray, length_mm, second);
                squares += 0.5 * difference * difference;
            }
        } while (watch.seconds() < seconds_per_row);
        row.ns_per_flight = 1.0e9 * watch.seconds() / (2.0 * double(pairs));
        row.variance = squares / double(pairs);
        rows_.push_back(row);
        fmt::print("{:<10} {:<6} {:.1f} {:<8} {:>2} cells{} {:>8.0f} ns {:>10.3e}\n", row.medium, row.field, row.contrast,
                   row.method, row.cells, row.fitted ? "*" : " ", row.ns_per_flight, row.variance);
        std::fflush(stdout);
    }

    std::vector<MediaBenchRow> rows_;
};

}  // namespace

std::vector<MediaBenchRow> bench_media() {
    return MediaBench().run();
}

}  // namespace opal
