// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "cell_oracle.h"
#include "formats/random.h"
#include "renderer/core/exchange_region.h"
#include "renderer/host/cell_data.h"

namespace opal {
namespace {

constexpr double half_mm = 10.0;

double draw(std::uint64_t index, std::uint32_t word) {
    const RandomBlock block = random_block(23, RandomStream::bench, index, word / 4);
    return double(uniform_float(block.value[word % 4]));
}

Vec3 direction_at(std::uint64_t index, std::uint32_t word) {
    const double z = 2.0 * draw(index, word) - 1.0, azimuth = 6.283185307179586 * draw(index, word + 1);
    const double r = std::sqrt(1.0 - z * z);
    return {float(r * std::cos(azimuth)), float(r * std::sin(azimuth)), float(z)};
}

/// Wherever the region says that light surely is in the cell, the sites say so too; and it is not so careful as to be of no use:
/// what it holds of the straight way along A is, on average, at least half of what the cell does (the least of both for cells
/// that are convex is the whole).
TEST(ExchangeRegion, LiesInTheCell) {
    for (const double spread_mm : {0.0, 1.5}) {
        std::vector<Site> sites;
        for (std::uint64_t n = 0; n < 300; ++n) {
            const auto place = [&](std::uint32_t k) { return double(float(half_mm * (2.0 * draw(n, k) - 1.0))); };
            sites.push_back({{place(0), place(1), place(2)}, float(spread_mm * draw(n, 3)), std::int32_t(n) + 1});
        }
        ConvexBounds bounds;
        for (int corner = 0; corner < 8; ++corner)
            bounds.hold(half_mm * openvdb::Vec3d((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                                 (corner & 4) != 0 ? 1.0 : -1.0));
        const CellData cells(sites, bounds);
        const CellField field = cells.field();
        int held = 0, inside = 0;
        for (std::uint64_t trial = 1000; trial < 3000; ++trial) {
            const auto coordinate = [&](std::uint32_t k) { return float(0.9 * half_mm * (2.0 * draw(trial, k) - 1.0)); };
            const Vec3 place{coordinate(0), coordinate(1), coordinate(2)};
            const int cell = locate_cell(field, place, nearby_cell(field, place));
            const Vec3 a = direction_at(trial, 4), b = direction_at(trial, 8);
            ExchangeRegion region(a, b);
            region.keep_in_cell(field, place, cell, 4.0f);
            for (std::uint32_t step = 0; step < 24; ++step) {
                const float along_a = float(3.0 * draw(trial, 12 + 2 * step));
                const float along_b = step % 3 == 0 ? 0.0f : float(3.0 * draw(trial, 13 + 2 * step));
                const Vec3 there = place + along_a * a + along_b * b;
                const bool same = locate_cell(field, there, cell) == cell;
                if (same) ++inside;
                if (!region.holds(along_a, along_b)) continue;
                ++held;
                EXPECT_TRUE(same) << "trial " << trial << ", " << along_a << ", " << along_b;
            }
        }
        EXPECT_GT(held, inside / 2) << spread_mm;
    }
}

}  // namespace
}  // namespace opal
