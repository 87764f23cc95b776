#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Configures and builds a preset: scripts/build.sh programs|unit|quick-unit|all [PRESET]. "programs" leaves the tests out, "unit" is the unit
# tests alone (what the sanitizers run), "quick-unit" those without the modeler's, whose meshes take ten minutes to compile under sanitizers.
set -eu
cd "$(dirname "$0")/.."
targets=${1:-all}
preset=${2:-release}

[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null
case $targets in
    programs) cmake --build "build/$preset" --target opal-model opal-render opal-optics ;;
    unit) cmake --build "build/$preset" --target opal_formats_tests opal_modeler_tests opal_renderer_tests opal_optics_tests ;;
    quick-unit) cmake --build "build/$preset" --target opal_formats_tests opal_renderer_tests opal_optics_tests ;;
    all) cmake --build "build/$preset" ;;
    *) echo "usage: scripts/build.sh programs|unit|quick-unit|all [PRESET]" >&2; exit 2 ;;
esac
