// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chi_square.h"
#include "on_backends.h"
#include "small_opal.h"

namespace opal {
namespace {

class Companions : public OnBackends {};

/// Uniform light hides wrong weights between the lanes as long as their mean is right; a studio with coloured surroundings does
/// not. One wavelength per path is the reference: nothing is weighted there.
TEST_P(Companions, ChangeNothingButTheNoise) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_s_rayleigh_400nm_per_mm = 0.15;
    small.constants.sigma_s_mie_per_mm = 0.1;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.15);
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const auto render = [&](int companions, int samples) {
        return render_text("[render]\nseed = " + std::to_string(1 + companions) +
                               "\nwidth = 32\nheight = 32\nsampler = \"independent\"\n[camera]\nposition_mm = [0, -20, 8]\n"
                               "target_mm = [0, 0, 0]\nvertical_fov_deg = 18\n[opal]\ncompanions = " +
                               std::to_string(companions) +
                               "\n[[material]]\nname = \"floor\"\nalbedo = [0.7, 0.4, 0.2]\n[[object]]\nkind = \"plane\"\n"
                               "material = \"floor\"\ntranslate_mm = [0, 0, -3.1]\n[[object]]\nkind = \"opal\"\nfile = '" +
                               (folder / "opal.vdb").string() + "'\n",
                           samples, GetParam())
            .outcome.totals;
    };
    // Each render has random numbers of its own: with the same ones the heroes are the same, and so are their errors.
    const SpectrumTotals alone = render(0, 640);
    for (const int companions : {1, 3, 7}) {
        const SpectrumTotals together = render(companions, 288);
        double statistic = 0.0;
        int used = 0;
        for (std::size_t bin = 2; bin + 6 < num_bins; ++bin, ++used) {
            const auto mean = [&](const SpectrumTotals& totals) { return totals.radiance[bin] / double(totals.samples); };
            const auto variance = [&](const SpectrumTotals& totals) {
                return (totals.radiance_squared[bin] / double(totals.samples) - mean(totals) * mean(totals)) /
                       double(totals.samples);
            };
            const double difference = mean(together) - mean(alone);
            statistic += difference * difference / (variance(together) + variance(alone));
        }
        EXPECT_LT(statistic, chi_square_limit(used)) << companions << " companions";
        EXPECT_GT(statistic, 0.25 * used) << "errors are overestimated: the test would see nothing";
    }
}

INSTANTIATE_TEST_SUITE_P(, Companions, cpu_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
