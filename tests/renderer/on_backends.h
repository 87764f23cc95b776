// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "backends.h"

namespace opal {

/// A suite whose tests draw with the backend that their parameter names, skipped where it cannot be had.
class OnBackends : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        if (const std::string why = missing_backend(GetParam()); !why.empty()) GTEST_SKIP() << why;
    }
};

/// For every test that draws.
inline auto cpu_and_cuda() {
    return testing::Values("cpu", "cuda");
}
/// For short ones of each kind: suites whose names end with Loop.
inline auto cpu_loop_and_cuda() {
    return testing::Values("cpu", "loop", "cuda");
}
inline std::string backend_name(const testing::TestParamInfo<const char*>& info) {
    return info.param;
}

}  // namespace opal
