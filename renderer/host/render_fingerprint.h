// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "formats/scene.h"

namespace opal {

/// What decides every sample of a render, as text, a line each: program version; the resolved scene's keys but those that say how
/// many samples there are or how the picture is shown; of files, in place of their names, hashes of their content. Two renders
/// whose fingerprints are equal have equal samples. Throws InputError where a file cannot be read.
std::string render_fingerprint(const SceneDescription& scene);

/// The first thing in which two fingerprints differ, for people; empty where they are equal. `first` and `second` say whose they
/// are: "camera.vertical_fov_deg is 20 in part1.exr and 25 in part2.exr".
std::string fingerprint_difference(const std::string& first_fingerprint, const std::string& first,
                                   const std::string& second_fingerprint, const std::string& second);

}  // namespace opal
