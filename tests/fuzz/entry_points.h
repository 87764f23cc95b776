// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// Readers of untrusted text and bytes, one call each: for coverage-guided fuzzing and for the mutated cases of opal_fuzz. Each
/// returns false where the input was refused by an InputError, and throws std::logic_error where what it read does not hold.
namespace opal::fuzz {

/// A scene.toml: what is read can be written and read again to the same text.
bool check_scene_text(const std::string& text);

/// A recipe.toml, likewise.
bool check_recipe_text(const std::string& text);

/// The checkpoint of a render of still.toml's size (12 x 9 pixels).
bool check_checkpoint_bytes(const std::string& bytes);

/// The metadata of an opal .vdb, as lines "name = value".
bool check_opal_metadata_text(const std::string& text);

}  // namespace opal::fuzz
