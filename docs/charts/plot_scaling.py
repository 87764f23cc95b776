#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost against size: small charts from scaling.csv, which `opal-bench scaling -o DIR` writes.

    docs/charts/plot_scaling.py DIR/scaling.csv PICTURE.png
"""
import pathlib
import sys

import style
from style import plt

# Title, what the curves' names begin with (any of these), label of y.
PANELS = [
    ("Modelling over sites", ["modelling: placing", "modelling: neighbours", "modelling: labels, 256", "modelling: labels, 64"],
     "processor seconds"),
    ("Modelling over voxels", ["modelling: level set", "modelling: labels, 1,000"], "processor seconds"),
    ("Preparing to render by cells", ["rendering: preparing cells"], "processor seconds"),
    ("Grains along rays, cells", ["rendering: 8 mm through cells", "rendering: a grain crossed"], "us"),
    ("Grains along rays, voxels", ["rendering: 8 mm through voxels"], "us per 8 mm"),
    ("Memory of cells", ["memory: cells"], "bytes"),
    ("Memory of labels", ["memory: labels"], "bytes"),
    ("Families of planes", ["rendering: a path, ball"], "us per path"),
    ("Scattering", ["rendering: a path, white ball"], "us per path"),
    ("Pixels: time", ["rendering: a path, at any"], "us per path"),
    ("Pixels: memory", ["memory: film"], "bytes"),
    ("Threads", ["rendering: a path, processor", "rendering: a path, by"], "us per path"),
]


def main():
    rows = style.read_rows(sys.argv[1])
    fits = {row["what"]: row for row in style.read_rows(pathlib.Path(sys.argv[1]).with_name("scaling_fits.csv"))}
    figure, axes = plt.subplots(3, 4, figsize=(14.0, 8.6), layout="constrained")
    for axis, (title, starts, label) in zip(axes.flat, PANELS):
        style.log_axes(axis)
        names = list(dict.fromkeys(row["what"] for row in rows if row["what"].startswith(tuple(starts))))
        for number, name in enumerate(names):
            points = [(row["size"], row["cost"], 0.0) for row in rows if row["what"] == name]
            short = name.split(": ", 1)[1]
            if name in fits and len(points) > 2:
                fit = fits[name]
                short += f"\n  N^({fit['exponent']:.2f} ± {fit['standard_error']:.2f}), last {fit['last_exponent']:.2f}"
            style.curve(axis, number, points, short)
            axis.set_xlabel(next(row["size_is"] for row in rows if row["what"] == name))
        sizes = sorted({row["size"] for row in rows if row["what"] in names})
        if sizes[-1] / sizes[0] < 40.0:
            axis.set_xticks(sizes, [f"{size:.0f}" for size in sizes], minor=False)
            axis.set_xticks([], minor=True)
        low, high = axis.get_ylim()
        if high / low < 30.0:
            axis.set_ylim(low / 3.0, high * 3.0)
        axis.set_title(title, loc="left")
        axis.set_ylabel(label)
        axis.legend(loc="best", handlelength=1.4, borderpad=0.2)
    style.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
