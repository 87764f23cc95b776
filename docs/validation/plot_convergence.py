#!/usr/bin/env python3
"""Errors over samples and over time, from convergence.csv that `opal-bench convergence -o DIR` writes.

usage: plot_convergence.py DIR/convergence.csv  ->  docs/validation/convergence.png
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

rows = list(csv.DictReader(open(sys.argv[1])))
scenes = list(dict.fromkeys((row["scene"], row["light"]) for row in rows))
settings = list(dict.fromkeys(row["setting"] for row in rows))
figure, axes = plt.subplots(4, len(scenes), figsize=(3.2 * len(scenes), 12), sharey="row")
for column, (scene, light) in enumerate(scenes):
    for kind, (quantity, cost) in enumerate(
        [(q, c) for q in ("luminance", "chroma") for c in ("samples", "seconds")]
    ):
        axis = axes[kind][column]
        for setting in settings:
            points = [
                row for row in rows if (row["scene"], row["light"]) == (scene, light) and row["setting"] == setting
            ]
            axis.errorbar(
                [float(row[cost]) for row in points],
                [float(row["relmse_" + quantity]) for row in points],
                [float(row["relmse_" + quantity + "_se"]) for row in points],
                label=setting, linewidth=1, capsize=2,
            )
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("samples per pixel" if cost == "samples" else "seconds")
        axis.grid(alpha=0.3, which="both")
        if column == 0:
            axis.set_ylabel("relMSE of " + quantity)
        if kind == 0:
            axis.set_title(f"{scene.replace('_', ' ')}, {light}")
axes[0][0].legend(fontsize=7)
figure.tight_layout()
figure.savefig(pathlib.Path(__file__).parent / "convergence.png", dpi=110)
