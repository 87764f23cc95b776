// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "case_random.h"

namespace opal::fuzz {

/// A random scene.toml that opal-render has to draw: every kind of object, material, light, camera, film and grain method, bodies
/// inside one another, values out to the ends of what is allowed. It names the seed files as lying beside it.
std::string random_scene(CaseRandom& random);

}  // namespace opal::fuzz
