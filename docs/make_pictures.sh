#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Makes the modeler's pictures of this folder again, from recipes: docs/make_pictures.sh [FOLDER]. Needs the built programs.
set -eu
cd "$(dirname "$0")/.."
pictures=${1:-docs}
opal_model=build/release/bin/opal-model
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Finer voxels than the recipe's, so that boundaries look as smooth as they are.
"$opal_model" build examples/precious_opal/recipe.toml -o "$work/precious_opal.vdb" --set grains.voxel_size_mm=0.02
"$opal_model" section "$work/precious_opal.vdb" -o "$pictures/section.png"

for tessellation in additive voronoi multiplicative manhattan; do
    "$opal_model" build docs/tessellations.toml -o "$work/$tessellation.vdb" --set grains.tessellation=$tessellation
done
"$opal_model" build docs/tessellations.toml -o "$work/additive with boundary noise.vdb" \
    --set 'grains.boundary_noise={amplitude_mm=0.12, scale_mm=0.5}'
"$opal_model" build docs/tessellations.toml -o "$work/additive, sintered.vdb" --set 'grains.sintering={probability=0.06}'
"$opal_model" section "$work/voronoi.vdb" "$work/additive.vdb" "$work/multiplicative.vdb" "$work/manhattan.vdb" \
    "$work/additive with boundary noise.vdb" "$work/additive, sintered.vdb" -o "$pictures/tessellations.png"
ls -l "$pictures/section.png" "$pictures/tessellations.png"
