#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to a picture of an opal: installs what is missing, builds, models, renders into out/.
# A second run starts from what is built.
set -eu
cd "$(dirname "$0")/.."

sh scripts/install_dependencies.sh
sh scripts/build.sh programs

mkdir -p out
echo "modelling"
build/release/bin/opal-model build examples/precious_opal/recipe.toml -o out/precious_opal.vdb --report out/precious_opal.report.json
echo "rendering"
build/release/bin/opal-render examples/precious_opal/scene.toml -o out/precious_opal.exr --stats out/precious_opal.stats.json \
    --set render.width=640 --set render.height=480 --spp 96 "$@"

echo
echo "the opal:    out/precious_opal.vdb   (opens in Blender and Houdini; build/release/bin/opal-model info shows what is inside)"
echo "the picture: out/precious_opal.png   (linear light with variance in out/precious_opal.exr)"
