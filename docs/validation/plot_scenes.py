#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots of metals and rough surfaces: plot_scenes.py DIR, where `opal-bench materials -o DIR` wrote its tables. Crosses are single
measurements from the papers named in formats/metals.h, as the tests use them."""
import csv
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

MEASURED = {  # wavelength_nm, n, k
    "gold": [(450.9, 1.38, 1.914), (548.6, 0.43, 2.455), (704.5, 0.13, 4.103)],
    "silver": [(413.3, 0.05, 2.275), (548.6, 0.06, 3.586), (756.0, 0.03, 5.242)],
    "copper": [(450.9, 1.24, 2.397), (548.6, 1.02, 2.577), (659.5, 0.22, 3.747)],
    "rhodium": [(400.0, 1.41, 4.20), (539.1, 1.94, 4.94), (729.3, 2.42, 6.33)],
}
COLORS = {"gold": "#c89b2a", "silver": "#8a8f98", "copper": "#b5603c", "platinum": "#5a7a8c", "rhodium": "#333333",
          "gold-silver": "#9fae5a"}


def read(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {key: [float(row[key]) for row in rows] for key in rows[0]}


def main():
    folder, here = Path(sys.argv[1]), Path(__file__).parent
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    metals = read(folder / "metals.csv")
    for name, color in COLORS.items():
        left.plot(metals["wavelength_nm"], metals[name], color=color, label=name)
        for wavelength, n, k in MEASURED.get(name, []):
            left.plot(wavelength, ((n - 1) ** 2 + k * k) / ((n + 1) ** 2 + k * k), "x", color=color)
    left.set(xlabel="wavelength, nm", ylabel="reflectance at normal incidence", ylim=(0, 1), title="Metals (crosses: measured)")
    left.legend(fontsize=8)
    rough = read(folder / "rough_surfaces.csv")
    for key, label, color in (("metal", "metal", "#333333"), ("glass_from_outside", "glass, from outside", "#2a6fb0"),
                              ("glass_from_inside", "glass, from inside", "#b0452a")):
        for cosine, style in ((1.0, "-"), (0.3, "--")):
            points = [(r, v) for r, c, v in zip(rough["roughness"], rough["cosine"], rough[key]) if c == cosine]
            right.plot(*zip(*points), style, color=color, label=label if cosine == 1.0 else None)
    right.axhline(1.0, color="#999999", linewidth=0.8)
    right.set(xlabel="roughness", ylabel="share of light", ylim=(0, 1.05),
              title="Light that turns once (dashed: at 72 degrees)")
    right.legend(fontsize=8)
    figure.savefig(here / "scenes.png", dpi=110)


main()
