// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaling_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <numeric>

#include "bench_chart.h"
#include "cell_samples.h"
#include "formats/atomic_file.h"
#include "formats/command.h"
#include "formats/error.h"
#include "formats/recipe.h"
#include "modeler/labelling.h"
#include "modeler/neighbour_graph.h"
#include "modeler/shape.h"
#include "modeler/sites.h"
#include "modeler/weights.h"
#include "power_law.h"
#include "renderer/core/cell_walk.h"
#include "renderer/host/grain_grid.h"
#include "small_opal.h"
#include "stability_media.h"
#include "timed_render.h"

namespace opal {
namespace {

using namespace cell_samples;

/// One measurement.
struct ScalingRow {
    std::string what, size_is;
    double size = 0.0, cost = 0.0;
    std::string unit;
};

/// Processor seconds of the work, done again until a fifth of a second has been spent.
double processor_seconds_of(const std::function<void()>& work) {
    const double begin = processor_seconds();
    int count = 0;
    do {
        work();
        ++count;
    } while (processor_seconds() - begin < 0.2);
    return (processor_seconds() - begin) / count;
}

std::unique_ptr<Shape> ball(double diameter_mm) {
    ShapeRecipe recipe;
    recipe.kind = ShapeKind::sphere;
    recipe.size_mm = {diameter_mm, diameter_mm, diameter_mm};
    return make_shape(recipe);
}

constexpr double ball_mm = 20.0;

struct Chords {
    std::vector<Vec3> origins, directions;
    float length_mm = 8.0f;
};

/// Chords of one length in the middle of the ball.
Chords chords_of(const Shape& shape, int count) {
    const openvdb::Vec3d centre_mm = shape.bounds_mm().getCenter();
    Draws draws(21);
    Chords chords;
    for (int n = 0; n < count; ++n) {
        const Vec3 direction = draws.direction();
        chords.origins.push_back(to_vec3(centre_mm + draws.in_cube(3.0)) - 0.5f * chords.length_mm * direction);
        chords.directions.push_back(direction);
    }
    return chords;
}

/// A ball of 6 mm in the studio.
TimedRender render_opal(double sphere_diameter_nm, int width, int samples, int threads) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = sphere_diameter_nm;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.5);
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    return timed_render(fmt::format("[render]\nwidth = {}\nheight = {}\n[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, "
                                    "0]\nvertical_fov_deg = 12\n[[object]]\nkind = \"opal\"\nfile = '{}'\n",
                                    width, width * 3 / 4, (folder / "opal.vdb").string()),
                        samples, threads);
}

class ScalingBench {
  public:
    explicit ScalingBench(bool quick) : quick_(quick) {}

    std::vector<ScalingRow> run() {
        model_sites();
        model_voxels();
        walk_cells();
        walk_voxels();
        turn_by_points();
        scatter();
        render_pixels();
        use_threads();
        return std::move(rows_);
    }

  private:
    void add(const std::string& what, const std::string& size_is, double size, double cost, const std::string& unit) {
        rows_.push_back({what, size_is, size, cost, unit});
        fmt::print("{:<44} {:<24} {:>10.6g}: {:>10.4g} {}\n", what, size_is, size, cost, unit);
        std::fflush(stdout);
    }

    void model_sites() {
        const auto shape = ball(ball_mm);
        const auto level_set = shape->level_set(ball_mm / (quick_ ? 64 : 256));
        for (double size = 100.0; size < (quick_ ? 2.0e4 : 1.1e6); size *= std::sqrt(10.0)) {
            GrainsRecipe recipe;
            recipe.num_sites = std::lround(size);
            const std::vector<char> hidden(std::size_t(recipe.num_sites), 0);
            SiteSet set;
            const double sampling = processor_seconds_of([&] { set = sample_sites(*shape, recipe); });
            const std::vector<Site> sites = weigh_sites(set, recipe, *shape).sites;
            const double neighbours = processor_seconds_of([&] { apollonius_graph(sites, hidden, *shape, set.spacing_mm()); });
            std::vector<std::int32_t> labels(sites.size());
            std::iota(labels.begin(), labels.end(), 1);
            const double labelling = processor_seconds_of([&] { label_voxels(sites, labels, *level_set); });
            const double n = double(recipe.num_sites);
            add("modelling: placing sites", "sites", n, sampling, "s");
            add("modelling: neighbours", "sites", n, neighbours, "s");
            add(quick_ ? "modelling: labels, 64^3 voxels" : "modelling: labels, 256^3 voxels", "sites", n, labelling, "s");
        }
    }

    void model_voxels() {
        const auto shape = ball(ball_mm);
        GrainsRecipe recipe;
        recipe.num_sites = 1000;
        const std::vector<Site> sites = weigh_sites(sample_sites(*shape, recipe), recipe, *shape).sites;
        std::vector<std::int32_t> labels(sites.size());
        std::iota(labels.begin(), labels.end(), 1);
        for (int across = 64; across <= (quick_ ? 128 : 512); across *= 2) {
            openvdb::FloatGrid::Ptr level_set;
            const double shaping = processor_seconds_of([&] { level_set = shape->level_set(ball_mm / across); });
            openvdb::Int32Grid::Ptr grid;
            const double labelling = processor_seconds_of([&] { grid = label_voxels(sites, labels, *level_set); });
            add("modelling: level set", "voxels across", across, shaping, "s");
            add("modelling: labels, 1,000 sites", "voxels across", across, labelling, "s");
            add("memory: labels, 1,000 sites", "voxels across", across, double(grid->memUsage()), "bytes");
        }
    }

    void walk_cells() {
        const auto shape = ball(ball_mm);
        const Chords chords = chords_of(*shape, 500);
        ConvexBounds bounds;
        bounds.hold_inside(*shape->level_set(ball_mm / 32.0));
        bounds.widen(2.0 * ball_mm / 32.0);
        for (double size = 100.0; size < (quick_ ? 4.0e3 : 1.1e5); size *= std::sqrt(10.0)) {
            GrainsRecipe recipe;
            recipe.num_sites = std::lround(size);
            std::vector<Site> sites = weigh_sites(sample_sites(*shape, recipe), recipe, *shape).sites;
            for (std::size_t n = 0; n < sites.size(); ++n) sites[n].grain = std::int32_t(n) + 1;
            const double begin = processor_seconds();
            const CellData cells(sites, bounds);
            const double building = processor_seconds() - begin;
            const double seconds = walk<CellWalk>(cells.field(), chords);
            add("rendering: preparing cells", "sites", double(sites.size()), building, "s");
            add("rendering: 8 mm through cells", "sites", double(sites.size()), 1.0e6 * seconds, "us");
            add("rendering: a grain crossed, cells", "sites", double(sites.size()), 1.0e6 * seconds / crossed_, "us");
            add("memory: cells", "sites", double(sites.size()), double(cells.size_bytes()), "bytes");
        }
    }

    void walk_voxels() {
        const auto shape = ball(ball_mm);
        const Chords chords = chords_of(*shape, 200);
        GrainsRecipe recipe;
        recipe.num_sites = 1000;
        const std::vector<Site> sites = weigh_sites(sample_sites(*shape, recipe), recipe, *shape).sites;
        std::vector<std::int32_t> labels(sites.size());
        std::iota(labels.begin(), labels.end(), 1);
        for (int across = 64; across <= (quick_ ? 128 : 512); across *= 2) {
            const GrainGridData voxels(*label_voxels(sites, labels, *shape->level_set(ball_mm / across)));
            add("rendering: 8 mm through voxels, 1,000 sites", "voxels across", across,
                1.0e6 * walk<GrainWalk>(voxels.field(), chords), "us");
        }
    }

    /// Processor seconds per chord; leaves the mean number of grains on it.
    template <class Walk, class Field>
    double walk(const Field& field, const Chords& chords) {
        std::uint64_t crossed = 0, walks = 0;
        const double seconds = processor_seconds_of([&] {
            for (std::size_t n = 0; n < chords.origins.size(); ++n) {
                Walk one(field, chords.origins[n], chords.directions[n]);
                float distance = 0.0f;
                int grain = 0;
                while ((grain = one.next_grain(grain, distance, chords.length_mm)) != 0) ++crossed;
                ++walks;
            }
        });
        crossed_ = double(crossed) / double(walks);
        return seconds / double(chords.origins.size());
    }

    void turn_by_points() {
        for (const double diameter_nm : {200.0, 250.0, 260.0, 300.0, 350.0, 400.0}) {
            const TimedRender render = render_opal(diameter_nm, 96, quick_ ? 4 : 48, 2);
            if (!rows_.empty() && rows_.back().what == "rendering: a path, ball of 6 mm" &&
                rows_.back().size == double(render.reciprocal_points))
                continue;
            add("rendering: a path, ball of 6 mm", "reciprocal points", render.reciprocal_points, render.processor_us_per_path(),
                "us");
        }
    }

    void scatter() {
        for (const double depth : {0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0}) {
            if (quick_ && depth > 50.0) break;
            const ScatteringBall measured = scattering_ball(depth, 10000, quick_ ? 8 : (depth > 200.0 ? 32 : 64));
            add("rendering: a path, white ball", "optical depth", depth, measured.us_per_path, "us");
        }
    }

    void render_pixels() {
        for (int width = 64; width <= (quick_ ? 256 : 2048); width *= 2) {
            const TimedRender render = render_opal(250.0, width, quick_ ? 1 : std::clamp(4096 / width, 1, 16), 2);
            const double pixels = double(width) * (width * 3 / 4);
            add("rendering: a path, at any picture's size", "pixels", pixels, render.processor_us_per_path(), "us");
            add("memory: film and picture", "pixels", pixels, render.film_bytes, "bytes");
        }
    }

    /// The fastest of some runs in turn: others may use the machine too.
    void use_threads() {
        double processor_us[2] = {1.0e30, 1.0e30}, clock_us[2] = {1.0e30, 1.0e30};
        for (int run = 0; run < (quick_ ? 1 : 4); ++run)
            for (std::size_t n = 0; n < 2; ++n) {
                const TimedRender render = render_opal(250.0, quick_ ? 96 : 240, quick_ ? 4 : 24, int(n) + 1);
                processor_us[n] = std::min(processor_us[n], render.processor_us_per_path());
                clock_us[n] = std::min(clock_us[n], render.clock_us_per_path());
            }
        for (std::size_t n = 0; n < 2; ++n) {
            add("rendering: a path, processor time", "threads", double(n + 1), processor_us[n], "us");
            add("rendering: a path, by the clock", "threads", double(n + 1), clock_us[n], "us by the clock");
        }
    }

    bool quick_;
    double crossed_ = 1.0;
    std::vector<ScalingRow> rows_;
};

void write_fits(const std::vector<ScalingRow>& rows, const std::filesystem::path& path) {
    AtomicFile file(path);
    std::ofstream csv(file.temporary_path());
    csv << "what,size_is,points,exponent,standard_error,last_exponent\n";
    std::vector<std::string> done;
    for (const ScalingRow& row : rows) {
        if (std::find(done.begin(), done.end(), row.what) != done.end()) continue;
        done.push_back(row.what);
        std::vector<SizedCost> points;
        for (const ScalingRow& other : rows)
            if (other.what == row.what && other.cost > 0.0) points.push_back({other.size, other.cost});
        if (points.size() < 2) continue;
        const PowerLaw law = fit_power_law(points);
        csv << fmt::format("\"{}\",{},{},{:.3f},{:.3f},{:.3f}\n", row.what, row.size_is, points.size(), law.exponent,
                           law.standard_error, law.last_exponent);
        fmt::print("{:<44} ~ {}^({:.2f} +- {:.2f}), last {:.2f}\n", row.what, row.size_is, law.exponent, law.standard_error,
                   law.last_exponent);
    }
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", path.string()));
    file.commit();
}

}  // namespace

void bench_scaling(const std::filesystem::path& folder, bool quick) {
    initialize_openvdb();
    std::filesystem::create_directories(folder);
    const std::vector<ScalingRow> rows = ScalingBench(quick).run();
    const std::filesystem::path csv_path = folder / "scaling.csv";
    AtomicFile file(csv_path);
    std::ofstream csv(file.temporary_path());
    csv << "what,size_is,size,cost,unit\n";
    for (const ScalingRow& row : rows)
        csv << fmt::format("\"{}\",{},{:.6g},{:.6g},{}\n", row.what, row.size_is, row.size, row.cost, row.unit);
    csv.close();
    if (!csv) throw SystemError(fmt::format("{}: writing failed", csv_path.string()));
    file.commit();
    write_fits(rows, folder / "scaling_fits.csv");
    draw_chart("plot_scaling.py", csv_path);
}

}  // namespace opal
