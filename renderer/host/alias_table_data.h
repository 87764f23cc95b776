// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "renderer/core/alias_table.h"

namespace opal {

/// Owns an alias table.
struct AliasTableData {
    std::vector<AliasColumn> columns;

    AliasTable view() const { return {columns.data(), static_cast<int>(columns.size())}; }
};

/// Builds the table of weights that are at least 0, one of them positive, in linear time (Vose 1991, "A linear algorithm for
/// generating random numbers with a given distribution"), in double precision.
AliasTableData make_alias_table(const std::vector<float>& weights);

}  // namespace opal
