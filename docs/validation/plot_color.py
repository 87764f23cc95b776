#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Charts of upsampling: python3 docs/validation/plot_color.py FOLDER, after opal-bench color -o FOLDER.

Writes color_round_trip.png (how often a round trip's error passes a given dE) and color_multiplication.png (products in RGB
against products of spectra) beside itself.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

here = pathlib.Path(__file__).parent
folder = pathlib.Path(sys.argv[1])
methods = {"jakob-hanika": ("Jakob-Hanika", "#1f77b4"), "smits": ("Smits", "#d62728"), "basis": ("basis", "#2ca02c")}


def rows(name):
    with open(folder / name, newline="") as stream:
        return list(csv.DictReader(stream))


def round_trip():
    table = rows("upsampling_round_trip_colors.csv")
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.6))
    for method, (label, color) in methods.items():
        chosen = [row for row in table if row["method"] == method]
        error = np.array([float(row["delta_e"]) for row in chosen])
        largest = np.array([max(float(row[c]) for c in "rgb") for row in chosen])
        ordered = np.sort(np.maximum(error, 1e-6))
        shown = label if error.max() > 1e-3 else f"{label}: all below {error.max():.0e}"
        axes[0].loglog(ordered, 1.0 - np.arange(len(ordered)) / len(ordered), color=color, label=shown)
        levels = np.unique(largest)
        mean = [error[largest == level].mean() for level in levels]
        axes[1].semilogy(levels, np.maximum(mean, 1e-6), color=color, label=label)
    axes[0].axvline(1.0, color="0.7", lw=0.8)
    axes[0].set_xlim(1e-3, 10.0)
    axes[0].set_ylim(1e-5, 2.0)
    axes[0].set_xlabel("round-trip error dE*ab")
    axes[0].set_ylabel("share of the cube above it")
    axes[1].set_xlabel("largest component (linear sRGB)")
    axes[1].set_ylabel("mean dE*ab")
    axes[0].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(here / "color_round_trip.png", dpi=110)


def multiplication():
    table = rows("multiplication.csv")
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.6), sharey=True)
    for axis, (factor, title) in zip(axes, (("itself", "a colour by itself"), ("another", "by another colour"))):
        for method, (label, color) in methods.items():
            chosen = [row for row in table if row["method"] == method and row["factor"] == factor]
            n = [int(row["multiplications"]) for row in chosen]
            axis.plot(n, [float(row["mean_delta_e"]) for row in chosen], "o-", ms=3, color=color, label=f"{label}, mean")
            axis.plot(n, [float(row["percentile_95_delta_e"]) for row in chosen], "--", lw=1, color=color, label=f"{label}, 95 %")
        axis.set_title(title, fontsize=10)
        axis.set_xlabel("multiplications")
    axes[0].set_ylabel("RGB against spectral, dE*ab")
    axes[0].set_ylim(0.0, 85.0)
    axes[1].legend(frameon=False, fontsize=8, ncol=2, loc="upper center")
    figure.tight_layout()
    figure.savefig(here / "color_multiplication.png", dpi=110)


round_trip()
multiplication()
