// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "small_opal.h"

namespace opal {
namespace {

/// Paths in a grey, milky, absorbing ball lose half of their light every millimetre or two: ending the weak ones at random
/// changes what single paths bring, but no mean.
TEST(Roulette, ChangesNoMean) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 280.0;
    small.constants.sigma_a_per_mm = SampledSpectrum{{380.0, 780.0}, {0.3, 0.3}};
    small.constants.sigma_s_mie_per_mm = 1.5;
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const auto mean = [&](const std::string& settings) {
        const Rendered rendered =
            render_text("[render]\nwidth = 32\nheight = 32\nsampler = \"independent\"\nfilter = \"box\"\n" + settings +
                            "[camera]\nposition_mm = [0, -20, 5]\ntarget_mm = [0, 0, 0]\nvertical_fov_deg = 14\n"
                            "[environment]\nkind = \"constant\"\n[[object]]\nkind = \"opal\"\nfile = '" +
                            (folder / "opal.vdb").string() + "'\n",
                        96);
        return region_mean(rendered.image, "G", 0, 0, 32, 32);
    };
    const MeanEstimate with = mean("roulette = true\n"), without = mean("roulette = false\nseed = 2\n");
    const double error = std::hypot(with.standard_error, without.standard_error);
    EXPECT_NEAR(with.mean, without.mean, 4.0 * error);
    EXPECT_LT(error, 0.01 * without.mean) << "too noisy to say anything";
    EXPECT_GT(with.standard_error, 1.001 * without.standard_error) << "no path was ended";
}

}  // namespace
}  // namespace opal
