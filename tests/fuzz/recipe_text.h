// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "case_random.h"

namespace opal::fuzz {

/// A random recipe.toml of a small opal: every kind of shape, sites, tessellation, weight, sintering, orientation and field. It
/// names the seed files as lying beside it. Most can be built; some ask for what their sites cannot give, which is an error.
std::string random_recipe(CaseRandom& random);

}  // namespace opal::fuzz
