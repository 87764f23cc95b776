// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace opal::fuzz {

/// What cases are about.
enum class Lane {
    scenes,   ///< random valid scenes: each has to give a picture
    recipes,  ///< random recipes: each has to give an opal that `opal-model check` passes, or one error
    mutated,  ///< damaged files of every kind: each has to give a result or one error
};

/// Kinds of cases, by what is damaged in them. The names are those of `kind_names`.
enum class Kind {
    scene,
    recipe,
    scene_text,
    recipe_text,
    opal,
    opal_tools,
    checkpoint,
    develop,
    merge,
    compare,
    environment,
    mesh,
    table
};
const std::vector<std::string>& kind_names();

/// The kind that a case of a lane is of.
Kind kind_of(Lane lane, std::uint64_t index);

/// How a case ended.
struct CaseOutcome {
    bool refused = false;  ///< with one clear error
    std::string defect;    ///< what must not be; empty: nothing
    double lost_paths = 0.0, paths = 0.0;
};

/// Makes a case's files ("case...") in the folder of the seed files, runs its programs on them, looks at what comes of it, and
/// removes the outputs ("out..."), but not the case's files. `seed` and `index` decide all of it.
CaseOutcome run_case(const std::filesystem::path& folder, Kind kind, std::uint64_t seed, std::uint64_t index);

/// Removes a case's files and outputs.
void remove_case_files(const std::filesystem::path& folder);

}  // namespace opal::fuzz
