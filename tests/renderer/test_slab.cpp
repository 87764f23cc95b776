// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "on_backends.h"
#include "renderer/host/spectrum_tables.h"
#include "small_opal.h"

namespace opal {
namespace {

class Slab : public OnBackends {};

/// A plate of thickness d, index n, absorption sigma at normal incidence in uniform light of radiance 1 shows R + T of the
/// incoherent plate (Born & Wolf 1.6, intensities added): with F the Fresnel reflectance and a = exp(-sigma d),
///   T = (1-F)^2 a / (1 - F^2 a^2),  R = F + F a T.
double plate_radiance(double n, double sigma_per_mm, double thickness_mm) {
    const double f = std::pow((n - 1.0) / (n + 1.0), 2), a = std::exp(-sigma_per_mm * thickness_mm);
    const double transmitted = (1.0 - f) * (1.0 - f) * a / (1.0 - f * f * a * a);
    return f + f * a * transmitted + transmitted;
}

TEST_P(Slab, AbsorbsByBeerLambertAtEveryWavelength) {
    SmallOpal small;
    small.radius_mm = 4.0;
    small.half_thickness_mm = 0.5;
    small.grains = 4;
    small.constants.n_sphere = 1.5;
    small.constants.n_medium = 1.5;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 1.2);
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "slab.vdb");
    const Rendered rendered = render_text(
        "[render]\nwidth = 24\nheight = 24\nsampler = \"independent\"\n[film]\nspectral = true\n[camera]\nkind = "
        "\"orthographic\"\n"
        "position_mm = [0, 0, 30]\ntarget_mm = [0, 0, 0]\nup = [0, 1, 0]\nview_height_mm = 2.0\n[environment]\nkind = "
        "\"constant\"\n"
        "[[object]]\nkind = \"opal\"\nfile = '" +
            (folder / "slab.vdb").string() + "'\n",
        2048, GetParam());
    const SpectrumTablesData tables = make_spectrum_tables();
    for (int bin = 1; bin < num_bins - 1; ++bin) {
        double expected = 0.0, white = 0.0;
        int count = 0;
        for (double w = bin_centre_nm(bin) - 5.0; w <= bin_centre_nm(bin) + 5.0; w += 0.1, ++count) {
            white += double(table_at(tables.view().white, float(w)));
            expected +=
                double(table_at(tables.view().white, float(w))) * plate_radiance(1.5, small.constants.sigma_a_per_mm.at(w), 1.0);
        }
        const double n = double(rendered.outcome.totals.samples);
        const double mean = rendered.outcome.totals.radiance[std::size_t(bin)] / n;
        const double error = std::sqrt((rendered.outcome.totals.radiance_squared[std::size_t(bin)] / n - mean * mean) / n);
        EXPECT_NEAR(mean / (white / count), expected / white, 4.0 * error / (white / count)) << bin_centre_nm(bin) << " nm";
        EXPECT_LT(error / mean, 0.02);
        // The stored layers hold the same numbers.
        const int layer = rendered.image.find_channel("S0." + std::to_string(int(bin_centre_nm(bin))) + "nm");
        ASSERT_GE(layer, 0);
        double sum = 0.0;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) sum += double(rendered.image.pixel(x, y)[layer]);
        EXPECT_NEAR(sum / (24 * 24), mean, 1e-4 * mean);
    }
}

INSTANTIATE_TEST_SUITE_P(, Slab, cpu_loop_and_cuda(), backend_name);

}  // namespace
}  // namespace opal
