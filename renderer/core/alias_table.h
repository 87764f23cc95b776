// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/core/real.h"
#include "renderer/core/vec.h"

namespace opal {

/// One column of an alias table: it is itself for `keep` of its width, `other` for the rest.
struct AliasColumn {
    real keep = 1.0f;
    int other = 0;
};

/// Draws an index in proportion to its weight in constant time (Walker 1974, "New fast method for generating discrete random
/// numbers with arbitrary frequency distributions"; AliasTableData builds it). It maps the unit interval onto the indices piece
/// by piece, so neighbouring numbers may land far apart: for independent numbers. Stratified ones keep their strata only under a
/// monotone map, the inversion of the cumulative table.
struct AliasTable {
    const AliasColumn* columns = nullptr;
    int count = 0;

    /// The index for a number in [0, 1), and what is left of the number, again evenly distributed over [0, 1).
    OPAL_HD int sample(real u, real& within) const {
        const real position = u * real(count);
        const int column = min_of(int(position), count - 1);
        const real rest = min_of(position - real(column), 0.999999f);
        const AliasColumn& entry = columns[column];
        if (rest < entry.keep) {
            within = rest / entry.keep;
            return column;
        }
        within = (rest - entry.keep) / (1.0f - entry.keep);
        return entry.other;
    }
};

}  // namespace opal
