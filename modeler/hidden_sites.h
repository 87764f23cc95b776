// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/opal_asset.h"
#include "formats/recipe.h"

namespace opal {

/// Marks (1) the sites that own nothing in the tessellation. Additive: i is hidden by j where w_j - w_i >= |p_i - p_j|, in the
/// Manhattan metric by the same with its distance; with factors, by a smaller one in the same place. Of equal sites in one place
/// the first owns. Equal to a search through all pairs, in about n log n steps; in more where weights grow by nearly as much as
/// places are apart, which leaves many sites just visible.
std::vector<char> find_hidden_sites(const std::vector<Site>& sites, TessellationKind tessellation = TessellationKind::additive);

}  // namespace opal
