# SPDX-License-Identifier: Apache-2.0
"""What the charts of this folder have in common: quiet axes, colours that stay apart without colour vision, 110 dpi."""
import csv
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#555555"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X"]
DPI = 110

plt.rcParams.update({
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.labelsize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 3.6,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
})


def read_rows(path):
    """Rows of a .csv as dictionaries; what reads as a number is one."""
    rows = []
    with open(path, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            for key, value in row.items():
                try:
                    row[key] = float(value)
                except ValueError:
                    pass
            rows.append(row)
    return rows


def log_axes(axis, x=True, y=True):
    """Logarithmic axes with few labels."""
    for on, set_scale, ticks in ((x, axis.set_xscale, axis.xaxis), (y, axis.set_yscale, axis.yaxis)):
        if on:
            set_scale("log")
            ticks.set_major_locator(LogLocator(numticks=7))
            ticks.set_minor_formatter(NullFormatter())


def curve(axis, number, points, label, **settings):
    """Points (x, y, standard error) in the colour of their number; bars of one standard error where there is one."""
    points = sorted(point for point in points if all(map(math.isfinite, point)))
    x, y, error = zip(*points)
    colour = COLOURS[number % len(COLOURS)]
    axis.errorbar(x, y, yerr=error if any(error) else None, label=label, color=colour, marker=MARKERS[number % len(MARKERS)],
                  capsize=1.5, elinewidth=0.8, **settings)
    return colour


def save(figure, path):
    figure.savefig(path, dpi=DPI)
    plt.close(figure)
