// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "cell_samples.h"
#include "formats/scene.h"
#include "renderer/core/cell_walk.h"
#include "renderer/core/two_beam.h"
#include "renderer/host/mesh_data.h"
#include "small_opal.h"

/// The transport compiled for double precision (renderer/core/real.h): that it is double where it decides, and whole.
namespace opal {
namespace {

using namespace cell_samples;

static_assert(sizeof(real) == sizeof(double));

TEST(DoubleTransport, CellWalksAreAsExactAsDouble) {
    for (const double spread_mm : {0.0, 0.7, 3.0}) {
        const WalkErrors errors = errors_of<CellWalk>(random_sites(300, spread_mm, 1), 100, 2);
        EXPECT_GT(errors.crossings, 100u);
        EXPECT_EQ(errors.missed, 0u);
        EXPECT_EQ(errors.spurious, 0u);
        EXPECT_LE(errors.largest_error_mm, 2.0e-9);  // the oracle ends at 1e-9
        EXPECT_LE(errors.wrong_mm, 1.0e-9 * errors.length_mm);
    }
}

/// A direction a little longer than 1 would let a walk go to and fro at the boundary of two cells of different weights.
TEST(DoubleTransport, DirectionsStayOfUnitLengthInTurnedObjects) {
    ObjectDescription object;
    object.rotate_deg = {25.0, 37.0, 110.0};
    const RigidTransform transform = object_transform(object);
    const std::vector<Site> sites = random_sites(100, 3.0, 3);
    const CellData cells(sites, cube());
    Draws draws(4);
    for (int n = 0; n < 100; ++n) {
        const Vec3 direction = transform.local_from_world_direction(draws.direction());
        EXPECT_NEAR(length(direction), 1.0, 1.0e-15);
        const Vec3 origin = to_vec3(draws.in_cube(half_mm));
        const real end = way_out_mm(origin, direction);
        const auto exact = exact_stretches(sites, origin, direction, end);
        EXPECT_EQ(walked_stretches(CellWalk(cells.field(), origin, direction), end).size(), exact.size());
    }
}

TEST(DoubleTransport, PlanesReflectAsTheirFormulasSay) {
    double worst = 0.0;
    for (double x = 0.0; x < 40.0; x += 0.0037) worst = std::max(worst, std::abs(sine_squared(x) - std::pow(std::sin(x), 2)));
    EXPECT_LE(worst, 1.0e-15);
    for (double kappa_t = 0.01; kappa_t < 6.0; kappa_t *= 1.37) {
        const double odds = std::pow(std::sinh(kappa_t), 2);
        EXPECT_NEAR(block_reflection_odds(kappa_t, 0.0) / odds, 1.0, 1.0e-7)
            << kappa_t;  // 1/3 and 2/45 there are of single precision
    }
}

TEST(DoubleTransport, AnOpalInItsFurnaceIsInvisible) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 280.0;
    small.constants.sigma_s_mie_per_mm = 0.4;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "ball.vdb");
    const Rendered rendered = render_text(
        "[render]\nwidth = 24\nheight = 24\nmax_bounces = 1000\nsampler = \"independent\"\nfilter = \"box\"\n[camera]\n"
        "position_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 16\n[environment]\nkind = \"constant\"\n"
        "[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "ball.vdb").string() + "'\nrotate_deg = [20, 30, 40]\n",
        64);
    const MeanEstimate green = region_mean(rendered.image, "G", 0, 0, 24, 24);
    EXPECT_NEAR(green.mean, 1.0, 4.0 * green.standard_error);
    EXPECT_LT(green.standard_error, 0.01);
    EXPECT_EQ(rendered.outcome.counters.not_a_number, 0u);
    EXPECT_LE(rendered.outcome.counters.lost_paths, 1u);
}

}  // namespace
}  // namespace opal
