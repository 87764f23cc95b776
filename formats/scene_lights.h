// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/scene.h"
#include "formats/toml_reader.h"

namespace opal {

/// One [[light]] of a scene, validated. Throws InputError located at file:line:column.
LightDescription read_light(TomlSection section);

/// The light with every key of its kind spelled out.
std::string light_to_toml(const LightDescription& light);

}  // namespace opal
