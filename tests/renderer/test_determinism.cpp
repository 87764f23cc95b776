// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "small_opal.h"

namespace opal {
namespace {

Rendered render_with(int threads, const std::string& scene) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    return render_text(scene, 16);
}

TEST(Determinism, SameBitsFromAnyNumberOfThreads) {
    SmallOpal small;
    small.constants.sphere_diameter_nm = 300.0;
    small.constants.sigma_s_mie_per_mm = 0.2;
    small.constants.sigma_a_per_mm = absorber_spectrum("carbon", 0.2);
    const ScratchFolder folder;
    write_opal_asset(small.make(), folder / "opal.vdb");
    const std::string scene =
        "[render]\nwidth = 80\nheight = 60\n[film]\naovs = [\"object_id\", \"grain_id\", \"depth\", \"normal\"]\n"
        "[camera]\nposition_mm = [0, -20, 12]\ntarget_mm = [0, 0, 0]\n"
        "[[material]]\nname = \"m\"\n[[object]]\nkind = \"plane\"\nmaterial = \"m\"\ntranslate_mm = [0, 0, -3.1]\n"
        "[[object]]\nkind = \"opal\"\nfile = '" +
        (folder / "opal.vdb").string() + "'\n";
    const Rendered one = render_with(1, scene), two = render_with(2, scene), many = render_with(7, scene),
                   again = render_with(2, scene);
    EXPECT_EQ(one.image.channel_names.size(), 7u + 6u);
    EXPECT_EQ(one.image.pixels, two.image.pixels);
    EXPECT_EQ(one.image.pixels, many.image.pixels);
    EXPECT_EQ(two.image.pixels, again.image.pixels);
    EXPECT_EQ(one.outcome.totals.radiance, many.outcome.totals.radiance);
}

}  // namespace
}  // namespace opal
