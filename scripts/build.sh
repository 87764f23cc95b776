#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Configures and builds a preset: scripts/build.sh programs|all [PRESET]. "programs" leaves the tests out.
set -eu
cd "$(dirname "$0")/.."
targets=${1:-all}
preset=${2:-release}

[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null
case $targets in
    programs) cmake --build "build/$preset" --target opal-model opal-render ;;
    all) cmake --build "build/$preset" ;;
    *) echo "usage: scripts/build.sh programs|all [PRESET]" >&2; exit 2 ;;
esac
