#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds every row of the published table with our lattice graph and prints both numbers of grains and both modelling times.
# usage: compare.sh [--timed]     --timed labels 512^3 voxels and writes them, as the source's times include; else sites alone
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=${OPAL_MODEL:-$here/../../build/release/bin/opal-model}
grids='output.grids=["sites"]'
[ "${1:-}" != --timed ] || grids='output.grids=["grain_id","shape","sites"]'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for recipe in "$here"/figure_*.toml; do
    name=$(basename "$recipe" .toml)
    "$program" build "$recipe" -o "$work/opal.vdb" --set "$grids" --report "$work/$name.json" >"$work/log" 2>&1 \
        || { cat "$work/log" >&2; exit 1; }
done

python3 - "$here/published.csv" "$work" "${1:-}" <<'PYTHON'
import csv, json, sys
published, work, timed = sys.argv[1:4]
print("figure           sites   p     grains: source    ours   differ   seconds: source   ours   explained by 6 neighbours")
for row in csv.DictReader(line for line in open(published) if not line.startswith("#")):
    report = json.load(open(f"{work}/figure_{row['figure']}.json"))
    theirs, ours = int(row["num_grains"]), report["counts"]["grains"]
    difference = 100.0 * (ours - theirs) / theirs
    print(f"{row['figure']:16s} {row['num_sites']:>6s}  {row['p']:>4s}  {theirs:14d} {ours:7d}  {difference:+6.1f} %  "
          f"{row['modelling_s']:>15s} {report['seconds']['total']:6.2f}   {'yes' if abs(difference) <= 3.0 else 'no'}")
if not timed:
    print("Our seconds leave out labels and writing; compare.sh --timed includes them.")
PYTHON
