#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# blender.sh OPAL_MODEL EXAMPLE_FOLDER: opens an opal in Blender without a window and checks what Blender makes of it. Exit code 77
# where Blender is not installed.
set -eu
opal_model=$1
example_folder=$2
checks=$(dirname "$0")/check_in_blender.py

command -v blender >/dev/null || { echo "skipped: Blender is not installed (apt-get install blender)"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cat >"$folder/box.toml" <<'RECIPE'
[shape]
kind = "box"
size_mm = [6.0, 4.0, 2.0]
[grains]
num_sites = 60
voxel_size_mm = 0.1
[output]
for_blender = true
RECIPE
"$opal_model" build "$folder/box.toml" -o "$folder/box.vdb"
"$opal_model" section "$folder/box.vdb" --axis z --at 1 --size 318 -o "$folder/section.png"
# Blender ends with 0 whatever a script does, unless told otherwise.
blender -b --factory-startup --python-exit-code 1 -P "$checks" -- "$example_folder" "$folder/box.vdb" "$folder/section.png" "$folder" |
    grep -v '^Fra:' >"$folder/log" || { cat "$folder/log"; exit 1; }
cat "$folder/log"
grep -q "all checks passed" "$folder/log"
