#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where each method degrades: small charts from stability.csv, which `opal-bench stability -o DIR` writes.

    docs/charts/plot_stability.py DIR/stability.csv PICTURE.png
"""
import sys

import style
from style import plt

WRONG = "share of the length in the wrong grain"
# Title, case, unit, methods that contain one of these (none: all), label of y, logarithmic x, logarithmic y, line to guide the eye.
PANELS = [
    ("1, 2  Weights of neighbours nearly equal", "near-equal weights", WRONG, [], "length in the wrong grain", True, True, None),
    ("1  Far from the origin of the file", "far from the origin", WRONG, [], "length in the wrong grain", True, True, None),
    ("3  Grazing boundaries: time", "grazing boundaries", "processor time per ray (us)", ["cells", "sphere"], "us per ray", True,
     True, None),
    ("3  Grazing boundaries: error", "grazing boundaries", "error of a crossing across the boundary (mm)", [],
     "mm across the boundary", True, True, None),
    ("4  Ewald tolerance: reflected energy", "Ewald tolerance", "reflected energy over two-beam's", [], "over two-beam's", True, True,
     (1.0, "two-beam")),
    ("5  Zone edge against three-beam theory", "zone edges",
     "error of the reflected energy against three-beam theory", [], "error of the energy", False, True, None),
    ("5  Families at once, random light", "zone edges", "share of reflected light with two or more strong families", [],
     "share of reflected light", False, False, None),
    ("6  The largest grain at the threshold", "percolation", "share of the sites in the largest grain", [], "share of the sites",
     False, False, (0.2, "warned above")),
    ("6  ... and how it varies over seeds", "percolation", "standard deviation of that share over seeds", [],
     "standard deviation", False, False, None),
    ("7  Optical depth of a white ball", "optical depth", "share of the light cut off", [], "light cut off (reported)", True, False,
     None),
    ("7  ... what it costs", "optical depth", "processor time per path (us)", [], "us per path", True, True, None),
    ("8  Majorants too small or large: bias", "majorants", "relative error of what passes", [], "relative error", True, False, None),
    ("8  ... what it costs", "majorants", "processor time per flight (us)", [], "us per flight", True, True, None),
    ("9  Bands narrower than 10 nm", "narrow bands", "CIEDE2000", [], "CIEDE2000", True, True, (1.0, "just visible")),
    ("10  Bounces of a milky ball", "bounces", "share of the light reported as cut off", [], "light cut off (reported)", True, False,
     None),
    ("11  Voxels across a gem of 20 mm", "voxels across 20 mm", WRONG, [], "length in the wrong grain", True, True, None),
]


def matches(row, case, unit, methods):
    return row["case"] == case and row["unit"] == unit and (not methods or any(m in row["method"] for m in methods))


def draw(axis, rows, panel):
    title, case, unit, methods, label, log_x, log_y, guide = panel
    chosen = [row for row in rows if matches(row, case, unit, methods)]
    if log_x or log_y:
        style.log_axes(axis, log_x, log_y)
    names = list(dict.fromkeys(row["method"] for row in chosen))
    for number, name in enumerate(names):
        points = [(row["value"], row["error"], row["standard_error"]) for row in chosen if row["method"] == name]
        # Zero has no place on a logarithmic axis; nor has a mean that is less than its standard error.
        if log_y:
            points = [p for p in points if p[1] > p[2]]
        if log_x:
            points = [p for p in points if p[0] > 0.0]
        if points:
            style.curve(axis, number, points, name.replace("voxels, ", "").replace("two-beam, odds added, ", ""))
    if guide:
        axis.axhline(guide[0], color="#999999", linewidth=0.8, linestyle=":")
        axis.annotate(guide[1], (1.0, guide[0]), xycoords=("axes fraction", "data"), fontsize=6.5, color="#777777", ha="right",
                      va="bottom")
    axis.set_title(title, loc="left")
    axis.set_ylabel(label)
    axis.set_xlabel(chosen[0]["input"].replace("opal.", "") if chosen else "")
    if len(names) > 1:
        axis.legend(loc="best", handlelength=1.4, borderpad=0.2)


def main():
    rows = style.read_rows(sys.argv[1])
    figure, axes = plt.subplots(4, 4, figsize=(14.0, 11.2), layout="constrained")
    for axis, panel in zip(axes.flat, PANELS):
        draw(axis, rows, panel)
    style.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
