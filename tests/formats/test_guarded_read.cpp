// SPDX-License-Identifier: Apache-2.0
#include "formats/guarded_read.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "expect_error.h"
#include "formats/opal_asset.h"
#include "formats/opal_asset_io.h"
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace opal {
namespace {

TEST(GuardedRead, CrashesBecomeErrors) {
    EXPECT_INPUT_ERROR(require_no_crash("a.vdb", [] { std::raise(SIGSEGV); }),
                       "a.vdb: not a complete .vdb file, or a damaged one: reading it ends with a crash");
    EXPECT_INPUT_ERROR(require_no_crash("a.vdb", [] { std::abort(); }), "reading it ends with a crash");
    EXPECT_INPUT_ERROR(require_no_crash("a.vdb", [] { std::raise(SIGKILL); }), "is it larger than memory?");
}

TEST(GuardedRead, WhatItDoesIsLost) {
    int value = 1;
    require_no_crash("a.vdb", [&] { value = 2; });
    require_no_crash("a.vdb", [] { throw std::runtime_error("read again"); });
    EXPECT_EQ(value, 1);
}

/// A .vdb without our checksum, as other programs write it, damaged at one place after the other, in its header as in its
/// compressed blocks: a result or an error, of this process no crash.
TEST(GuardedRead, DamagedFilesOfOtherPrograms) {
    initialize_openvdb();
#ifdef __SANITIZE_ADDRESS__
    // OpenVDB loses the nodes that it was reading where a read fails.
    const __lsan::ScopedDisabler openvdb_leaks;
#endif
    const std::string path = (std::filesystem::temp_directory_path() / ("opal_guarded_" + std::to_string(::getpid()))).string();
    const auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) grid->tree().setValueOn({i, j, (7 * i + j) % 30}, 0.1f * float(i + j));
    openvdb::io::File(path).write({grid});
    std::ifstream whole(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(whole)), std::istreambuf_iterator<char>());
    int results = 0, errors = 0, crashes = 0;
    for (std::size_t k = 0; k < 100; ++k) {
        std::string damaged = bytes;
        damaged.replace(100 + k * (bytes.size() - 110) / 100, 4, k % 2 == 0 ? "\xff\xff\xff\x7f" : std::string(4, '\0'));
        std::ofstream(path, std::ios::binary) << damaged;
        try {
            read_raw_opal_file(path);
            ++results;
        } catch (const InputError& error) {
            ++errors;
            crashes += std::string(error.what()).find("ends with a crash") != std::string::npos ? 1 : 0;
        }
    }
    std::filesystem::remove(path);
    EXPECT_GT(results, 0);
    EXPECT_GT(errors, 0);
    RecordProperty("crashes", crashes);
    std::printf("%d results, %d errors, of these %d that would have been crashes\n", results, errors, crashes);
}

}  // namespace
}  // namespace opal
