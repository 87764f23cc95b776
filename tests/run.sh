#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to the test results: installs what is missing, builds, runs every test. Arguments go to ctest
# (for example -L unit). With OPAL_PRESET=asan or tsan the unit tests run under that sanitizer.
set -eu
cd "$(dirname "$0")/.."
preset=${OPAL_PRESET:-release}

sh scripts/install_dependencies.sh
if [ "$preset" = release ]; then sh scripts/build.sh all; else sh scripts/build.sh unit "$preset"; fi
ctest --preset "$preset" --parallel "$(nproc)" "$@"
