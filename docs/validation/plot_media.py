#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Charts of tracking through fields: reads the media.csv of `opal-bench media -o DIR`, prints a table as Markdown and writes
media_*.png beside this file. Needs matplotlib (Debian: python3-matplotlib).

    docs/validation/plot_media.py DIR/media.csv
"""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
NAMES = {"absorption": "absorption alone", "body": "absorption and scattering"}


def read_rows(path):
    with open(path, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        for key in ("contrast", "ns_per_flight", "variance", "ns_times_variance"):
            row[key] = float(row[key])
        row["cells"] = int(row["cells"])
        row["fitted"] = row["fitted"] == "1"
    return rows


def pick(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def print_table(rows):
    print("| medium | field | contrast | estimator | global: ns, variance | fitted: cells, ns, variance | cost x variance, global over fitted |")
    print("|---|---|---|---|---|---|---|")
    for one in pick(rows, fitted=True):
        same = {key: one[key] for key in ("medium", "field", "contrast", "method")}
        whole = pick(rows, fitted=False, cells=1, **same)[0]
        gain = whole["ns_times_variance"] / max(one["ns_times_variance"], 1e-30)
        print(f"| {NAMES[one['medium']]} | {one['field']} | {one['contrast']:g} | {one['method']} "
              f"| {whole['ns_per_flight']:.0f}, {whole['variance']:.2e} "
              f"| {one['cells']}, {one['ns_per_flight']:.0f}, {one['variance']:.2e} | {gain:.2f} |")


def plot_contrast(rows):
    figure, axes = plt.subplots(2, 3, figsize=(10.5, 6.2), sharex=True)
    for line, medium in enumerate(NAMES):
        for column, (key, label) in enumerate((("ns_per_flight", "ns per flight"), ("variance", "variance of one flight"),
                                               ("ns_times_variance", "time x variance (ns)"))):
            axis = axes[line][column]
            for method, colour in (("residual", "tab:blue"), ("ratio", "tab:orange")):
                for fitted, style in ((True, "-"), (False, "--")):
                    wanted = {"fitted": True} if fitted else {"fitted": False, "cells": 1}
                    series = pick(rows, medium=medium, field="waves", method=method, **wanted)
                    axis.plot([row["contrast"] for row in series], [row[key] for row in series], style, color=colour,
                              marker="o", markersize=3, label=f"{method}, {'local' if fitted else 'global'}")
            axis.set_yscale("log")
            axis.set_title(f"{NAMES[medium]}: {label}", fontsize=9)
            if line == 1:
                axis.set_xlabel("contrast of the field")
            axis.grid(True, which="both", alpha=0.2)
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "media_contrast.png", dpi=110)
    plt.close(figure)


def plot_cells(rows):
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.6))
    for axis, medium in zip(axes, NAMES):
        for (field, contrast), colour in zip((("waves", 0.5), ("layers", 0.5), ("clouds", 1.0)),
                                             ("tab:blue", "tab:green", "tab:red")):
            series = pick(rows, medium=medium, field=field, contrast=contrast, method="residual", fitted=False)
            axis.plot([row["cells"] for row in series], [row["ns_per_flight"] for row in series], "-", color=colour, marker="o",
                      markersize=3, label=f"{field}, contrast {contrast:g}")
            chosen = pick(rows, medium=medium, field=field, contrast=contrast, method="residual", fitted=True)[0]
            axis.plot([chosen["cells"]], [chosen["ns_per_flight"]], "*", color=colour, markersize=12)
        axis.set_xscale("log", base=2)
        axis.set_title(NAMES[medium], fontsize=9)
        axis.set_xlabel("majorant cells along the longest side (star: as fitted)")
        axis.set_ylabel("ns per flight")
        axis.set_ylim(bottom=0)
        axis.grid(True, alpha=0.2)
    axes[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "media_cells.png", dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path, help="media.csv")
    rows = read_rows(parser.parse_args().csv)
    print_table(rows)
    plot_contrast(rows)
    plot_cells(rows)


if __name__ == "__main__":
    main()
