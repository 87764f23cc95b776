// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "formats/error.h"
#include "renderer/optics/csv_table.h"
#include "renderer/optics/value_list.h"

namespace opal {
namespace {

using Values = std::vector<double>;

TEST(ValueList, NumbersListsAndRanges) {
    EXPECT_EQ(parse_values("--x", "2.5", 0.0, 10.0), Values({2.5}));
    EXPECT_EQ(parse_values("--x", "3,1,2", 0.0, 10.0), Values({3.0, 1.0, 2.0}));
    EXPECT_EQ(parse_values("--x", "0:60:20", 0.0, 60.0), Values({0.0, 20.0, 40.0, 60.0}));
    EXPECT_EQ(parse_values("--x", "0:50:20", 0.0, 60.0), Values({0.0, 20.0, 40.0}));
    EXPECT_EQ(parse_values("--x", "5:5:1", 0.0, 60.0), Values({5.0}));
    EXPECT_EQ(parse_values("--x", "0:1:0.1", 0.0, 1.0 + 1e-12).size(), 11u);
    EXPECT_EQ(parse_values("--x", "520:640:0.5", 200.0, 2500.0).size(), 241u);
}

TEST(ValueList, WhatIsRefused) {
    for (const char* text :
         {"", "a", "1,", ",1", "1:2", "1:2:0", "2:1:1", "1:2:-1", "1:2:3:4", "1 2", "nan", "inf", "1,x", "0:1:1e-9", "-1", "99"})
        EXPECT_THROW(parse_values("--x", text, 0.0, 10.0), InputError) << text;
    try {
        parse_values("--angle-deg", "0,95", 0.0, 90.0);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "--angle-deg 0,95: 95 is out of range; allowed: 0 to 90");
    }
}

TEST(CsvTable, TenDigitsWithoutTrailingNoise) {
    CsvTable table("a,b");
    table.add_row({520.6 + 1e-13, 1.0 / 3.0});
    table.add_row({1.0}, "#ffffff");
    EXPECT_EQ(table.text(), "a,b\n520.6,0.3333333333\n1,#ffffff\n");
}

}  // namespace
}  // namespace opal
