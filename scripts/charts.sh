#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Measures speed against accuracy, failures and scaling, and draws the charts that docs/ shows: expect most of an
# hour on two cores, with --quick some minutes. Needs a release build (scripts/build.sh).
# usage: scripts/charts.sh [--quick] [FOLDER]     (FOLDER: docs/charts without --quick, out/charts with it)
set -eu
cd "$(dirname "$0")/.."
quick=
if [ "${1:-}" = --quick ]; then quick=--quick; shift; fi
folder=${1:-}
if [ -z "$folder" ]; then
    if [ -n "$quick" ]; then folder=out/charts; else folder=docs/charts; fi
fi
mkdir -p "$folder"
for what in pareto shots stability scaling; do
    build/release/bin/opal-bench $what $quick -o "$folder"
done
