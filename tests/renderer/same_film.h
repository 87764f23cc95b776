// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/host/film.h"

namespace opal {

/// Within `relative` of the largest of the sequence of each other; 0: the same bits.
template <class Range>
void expect_close(const Range& a, const Range& b, double relative) {
    double largest = 0.0;
    for (const double value : a) largest = std::max(largest, std::abs(value));
    for (std::size_t i = 0; i < std::size(a); ++i) ASSERT_LE(std::abs(a[i] - b[i]), relative * largest) << i;
}

/// Sums of every pixel and block within `relative` of each other, and as many samples.
inline void expect_same_film(const Film& a, const Film& b, double relative) {
    ASSERT_EQ(a.num_blocks(), b.num_blocks());
    for (int i = 0; i < a.num_blocks(); ++i) {
        const SpectrumTotals &totals = a.block(i).totals, &others = b.block(i).totals;
        EXPECT_EQ(a.block(i).end_sample, b.block(i).end_sample);
        EXPECT_EQ(a.block(i).settled, b.block(i).settled);
        expect_close(totals.radiance, others.radiance, relative);
        expect_close(totals.radiance_squared, others.radiance_squared, relative);
        expect_close(totals.truncated, others.truncated, relative);
        expect_close(totals.truncated_squared, others.truncated_squared, relative);
        expect_close(totals.truncated_rgb, others.truncated_rgb, relative);
        EXPECT_EQ(totals.samples, others.samples);
        EXPECT_EQ(a.block(i).counters.diffractions, b.block(i).counters.diffractions);
        EXPECT_EQ(a.block(i).counters.scatterings, b.block(i).counters.scatterings);
        EXPECT_EQ(a.block(i).counters.truncated_paths, b.block(i).counters.truncated_paths);
    }
    for (std::uint32_t p = 0; p < std::uint32_t(a.width() * a.height()); ++p) {
        ASSERT_EQ(a.samples(p), b.samples(p)) << p;
        expect_close(a.sums(p), b.sums(p), relative);
    }
}

}  // namespace opal
