#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Chart of the ways to find the grains along a ray: reads the grains.csv of `opal-bench grains -o DIR`, prints a table as Markdown
and writes grains.png beside this file. Needs matplotlib (Debian: python3-matplotlib).

    docs/validation/plot_grains.py DIR/grains.csv
"""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
COLOURS = {"cells": "tab:green", "sphere-tracing": "tab:blue", "hyperboloid": "tab:red", "voxels": "tab:gray"}


def read_rows(path):
    with open(path, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        for key in row:
            if key not in ("weights", "method"):
                row[key] = float(row[key])
        row["name"] = f"{row['voxels_across']:.0f}^3 voxels" if row["method"] == "voxels" else row["method"]
    return rows


def print_table(rows):
    print("| weights | sites | method | ns per grain | memory | crossings missed | spurious | length in the wrong grain "
          "| error of a crossing, mean, largest |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        print(f"| {row['weights']} | {row['sites']:.0f} | {row['name']} | {row['ns_per_grain']:.0f} | {row['bytes'] / 1e6:.3g} MB "
              f"| {100 * row['missed'] / row['crossings']:.2g} % | {100 * row['spurious'] / row['crossings']:.2g} % "
              f"| {row['wrong_length']:.1e} | {row['mean_error_um']:.2g} um, {row['largest_error_um']:.2g} um |")


def plot(rows):
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4.0))
    for axis, key, label in ((axes[0], "bytes", "memory (bytes)"),
                             (axes[1], "wrong_length", "part of the length in the wrong grain")):
        for row in rows:
            if row["weights"] != "additive":
                continue
            many = row["sites"] > 10000
            axis.plot([row["ns_per_grain"]], [max(row[key], 1e-8)], marker="s" if many else "o", color=COLOURS[row["method"]],
                      markersize=7)
            axis.annotate(row["name"], (row["ns_per_grain"], max(row[key], 1e-8)), fontsize=7, ha="center",
                          xytext=(0, 7 if many else -13), textcoords="offset points")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlim(50, 2 * max(row["ns_per_grain"] for row in rows))
        axis.margins(y=0.1)
        axis.set_xlabel("ns per grain crossed, one thread")
        axis.set_ylabel(label)
        axis.grid(True, which="both", alpha=0.2)
    axes[0].set_title("circles: 1,000 sites; squares: 27,000", fontsize=9)
    axes[1].set_title("against a long-double oracle", fontsize=9)
    figure.tight_layout()
    figure.savefig(HERE / "grains.png", dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path, help="grains.csv")
    rows = read_rows(parser.parse_args().csv)
    print_table(rows)
    plot(rows)


if __name__ == "__main__":
    main()
