// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "formats/scene.h"
#include "formats/toml_reader.h"

namespace opal {

/// One [[material]] of a scene.toml, and back to text. Throws InputError located at the key.
MaterialDescription read_material(TomlSection section);
std::string material_to_toml(const MaterialDescription& material);

/// One [[object]] and back; `materials`: those that it may name.
ObjectDescription read_object(TomlSection section, const std::vector<MaterialDescription>& materials);
std::string object_to_toml(const ObjectDescription& object);

}  // namespace opal
