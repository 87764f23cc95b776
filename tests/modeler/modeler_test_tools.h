// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/opal_asset.h"
#include "formats/random.h"

namespace opal::testing_tools {

/// A name of its own for each process: tests run beside each other.
inline std::string temporary_file(const std::string& name) {
    return ::testing::TempDir() + "opal_" + std::to_string(::getpid()) + "_" + name;
}

/// Uniform in the box; a pure function of (seed, index).
inline openvdb::Vec3d random_point(const openvdb::BBoxd& box, std::uint64_t seed, std::uint64_t index) {
    const RandomBlock a = random_block(seed, RandomStream::pixel_scramble, index, 0);
    const RandomBlock b = random_block(seed, RandomStream::pixel_scramble, index, 1);
    const openvdb::Vec3d unit(uniform_double(a.value[0], a.value[1]), uniform_double(a.value[2], a.value[3]),
                              uniform_double(b.value[0], b.value[1]));
    return box.min() + unit * box.extents();
}

/// Sites spread at random, weights uniform in [-spread, spread].
inline std::vector<Site> random_sites(const openvdb::BBoxd& box, std::size_t count, double weight_spread_mm, std::uint64_t seed) {
    std::vector<Site> sites(count);
    for (std::size_t n = 0; n < count; ++n) {
        sites[n].position_mm = random_point(box, seed, n);
        const RandomBlock block = random_block(seed, RandomStream::pixel_scramble, n, 2);
        sites[n].weight_mm = static_cast<float>(weight_spread_mm * (2.0 * uniform_double(block.value[0], block.value[1]) - 1.0));
    }
    return sites;
}

/// Runs `work` with so many threads, even where the machine has fewer.
template <typename Work>
auto with_threads(int threads, const Work& work) {
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(work);
}

/// The message of the InputError that `work` throws; empty where it throws none.
template <typename Work>
std::string input_error_of(const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

/// Same values, same active states, same tiles and leaves.
template <typename Grid>
bool same_grids(const Grid& a, const Grid& b) {
    if (!a.tree().hasSameTopology(b.tree()) || a.transform() != b.transform()) return false;
    auto in_a = a.cbeginValueAll();
    auto in_b = b.cbeginValueAll();
    for (; in_a && in_b; ++in_a, ++in_b)
        if (in_a.getCoord() != in_b.getCoord() || in_a.getValue() != in_b.getValue() || in_a.isValueOn() != in_b.isValueOn())
            return false;
    return !in_a && !in_b;
}

/// A file in the tests' temporary folder.
inline std::string write_test_file(const std::string& name, const std::string& content) {
    const std::string path = temporary_file(name);
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

}  // namespace opal::testing_tools
