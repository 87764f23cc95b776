// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace opal {

/// "Model no more than a scene needs", shown: the precious opal from afar, as a product and close up, once with the whole model
/// (512 voxels along the longest side, labels and all) and once as `opal-model build --for SCENE` makes it for that picture.
/// Writes folder/shots.csv: what building, keeping, loading and drawing cost, and how far apart the two pictures are.
///
/// Colours are those of patches of the gem, 16 pixels on a side (4 from afar), as the picture shows them (the scene's exposure),
/// in CIELAB under D65. What the models' pictures converge to is told apart from noise by eight seeds; beside it stands what an
/// eye would compare: the 95th percentile of CIEDE2000 against the whole model drawn with other random numbers, for the whole
/// model too.
/// In the studio, and in the light tent with eight times the samples. `only`: names of shots; empty: all.
void bench_shots(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& only);

}  // namespace opal
