#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Speed against accuracy, from pareto.csv that `opal-bench pareto -o DIR` writes.

usage: plot_pareto.py pareto.csv pareto.png  ->  pareto.png, pareto_time.png and pareto.html beside it
"""
import base64
import csv
import html
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

COLORS = {"precious_opal": "#222222", "white_opal": "#3f88c5", "fire_opal": "#d1495b", "block": "#6a994e", "teapot": "#b56576"}
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
RESOLVED = 3.0  # standard errors, of the squared error of patches: of 500 such errors one or none is a mistake
RESOLVED_MEAN = 4.0  # of the mean
NOISE = 0.1  # of a pixel, to which costs refer


def read(table):
    rows = []
    for row in csv.DictReader(open(table)):
        for key, value in row.items():
            if key not in ("scene", "choice", "variant", "command"):
                row[key] = float(value)
        # What is wrong by less than the patches' noise may still show in the mean of all.
        # In the scene's own light and in the tent, where there is far less noise.
        row["error"] = 0.0
        for light in ("", "tent_"):
            squared, squared_se = row[light + "squared_error"], row[light + "squared_error_se"]
            mean, mean_se = abs(row[light + "mean_error"]), row[light + "mean_error_se"]
            patches = math.sqrt(max(squared, 0.0)) if squared > RESOLVED * squared_se else 0.0
            row["error"] = max(row["error"], patches, mean if mean > RESOLVED_MEAN * mean_se else 0.0)
        row["resolved"] = row["error"] > 0.0
        row["limit"] = math.sqrt(max(row["tent_squared_error"], 0.0) + RESOLVED * row["tent_squared_error_se"])
        rows.append(row)
    for row in rows:
        peers = [r for r in rows if (r["scene"], r["choice"]) == (row["scene"], row["choice"])]
        row["front"] = not any(
            r["cost_s"] < row["cost_s"] and r["error"] <= row["error"] and r is not row for r in peers
        )
        exact = next(r for r in peers if r["exact"])
        row["relative_cost"] = row["cost_s"] / exact["cost_s"]
        row["relative_cost_se"] = row["cost_se"] / exact["cost_s"]
    return rows


def plot_choices(rows, target):
    """A panel per choice: cost over error. On the front: filled."""
    choices = list(dict.fromkeys(row["choice"] for row in rows))
    columns = 3
    lines = math.ceil(len(choices) / columns)
    figure, axes = plt.subplots(lines, columns, figsize=(6.0 * columns, 3.4 * lines), squeeze=False)
    for axis in list(axes.flat)[len(choices) :]:
        axis.axis("off")
    floor = 1e-3
    for axis, choice in zip(axes.flat, choices):
        variants = list(dict.fromkeys(row["variant"] for row in rows if row["choice"] == choice))
        for row in rows:
            if row["choice"] != choice:
                continue
            color = COLORS[row["scene"]]
            error = max(row["error"] if row["resolved"] else row["limit"], floor)
            if row["exact"]:
                error = floor
            axis.plot(
                row["relative_cost"], error, MARKERS[variants.index(row["variant"]) % len(MARKERS)], color=color,
                fillstyle="full" if row["front"] else "none", markersize=7,
            )
            if not row["resolved"] and not row["exact"]:
                axis.annotate("", (row["relative_cost"], error / 1.8), (row["relative_cost"], error),
                              arrowprops={"arrowstyle": "->", "color": color, "lw": 0.7})
        for i, variant in enumerate(variants):
            axis.plot([], [], MARKERS[i % len(MARKERS)], color="#888888", label=variant.split(":")[0][:26])
        axis.set_xscale("log")
        axis.set_yscale("log")
        low, high = axis.get_xlim()
        axis.set_xlim(min(low, 0.5), max(high, 2.5))
        axis.xaxis.set_major_locator(LogLocator(base=10, subs=(1.0, 2.0, 5.0), numticks=12))
        axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
        axis.set_ylim(floor / 1.5, 4.0)
        axis.set_title(choice, fontsize=10)
        axis.grid(alpha=0.25, which="both")
        axis.tick_params(labelsize=7)
        axis.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    for axis in axes.flat[::columns]:
        axis.set_ylabel("error of the picture (bias, RMS)", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("time to equal noise over the exact choice's", fontsize=8)
    names = ", ".join(f"{name.replace('_', ' ')}: {color}" for name, color in (
        ("precious_opal", "black"), ("white_opal", "blue"), ("fire_opal", "red"), ("block", "green"), ("teapot", "pink")))
    figure.suptitle(
        f"Each choice by itself. {names}. Filled: on the front. Arrow: bias not resolved, upper limit in the tent. Lowest line: 0.1 % or less, the exact choice.",
        fontsize=10)
    figure.tight_layout(rect=(0, 0, 1, 0.98))
    figure.savefig(target, dpi=110)


def plot_time(rows, target):
    """Error (bias and noise) over time, of whole sets of settings."""
    rows = [row for row in rows if row["choice"] == "all together"]
    scenes = list(dict.fromkeys(row["scene"] for row in rows)) or ["not measured"]
    figure, axes = plt.subplots(1, len(scenes), figsize=(4.3 * len(scenes), 4.2), sharey=True, squeeze=False)
    times = [10.0 ** (k / 20.0) for k in range(20, 181)]
    styles = {"default": ("#888888", "--"), "draft": ("#f4a261", "-"), "preview": ("#2a9d8f", "-"),
              "final": ("#264653", "-"), "reference": ("#6d597a", "-"), "source": ("#d1495b", "-")}
    for axis, scene in zip(axes[0], scenes):
        for row in rows:
            if row["scene"] != scene:
                continue
            name = row["variant"].split(":")[0]
            color, style = styles[name]
            one_second = row["cost_s"] * NOISE**2
            axis.plot(times, [math.sqrt(row["error"] ** 2 + one_second / t) for t in times], style, color=color, label=name)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_ylim(0.01, 30)
        axis.set_title(scene.replace("_", " "))
        axis.set_xlabel("processor seconds, a million pixels of gem")
        axis.grid(alpha=0.3, which="both")
    axes[0][0].set_ylabel("error of a pixel: bias and noise")
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(target, dpi=110)


def percent(value):
    return f"{100.0 * value:.2g}"


def write_page(rows, picture_of_choices, picture_of_time, target):
    def picture(name):
        data = base64.b64encode(name.read_bytes()).decode()
        return f'<img src="data:image/png;base64,{data}" style="max-width:100%">'

    text = [
        "<!DOCTYPE html><html lang=en><meta charset=utf-8><title>Speed against accuracy</title><style>",
        "body{font:14px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1500px;color:#222}table{border-collapse:collapse;width:100%}",
        "td,th{padding:2px 8px;border-bottom:1px solid #ddd;text-align:right;font-variant-numeric:tabular-nums}",
        "td:nth-child(-n+3),th:nth-child(-n+3){text-align:left}tr.front{background:#eef6ee}code{font-size:11px;white-space:nowrap}",
        "details{display:inline}summary{cursor:pointer;color:#666}</style>",
        "<h1>Speed against accuracy</h1><p>Every choice that trades one for the other, alone, against its most exact value; then whole",
        " sets of settings. Cost: processor time until a million pixels of gem have 10 % noise. Error: bias alone (root mean square over patches",
        " as large as a grain of what the pictures converge to, relative; or of the mean of all, where that is larger), in the scene's own light or in the built-in tent, whichever shows",
        " more; &lt;: not resolved, upper limit of two standard errors, in the tent. Green: on the front,",
        " no cheaper value of that choice has as small an error.</p>",
        picture(picture_of_time), picture(picture_of_choices),
        "<table><tr><th>scene<th>choice<th>value<th>cost, s<th>over exact<th>&micro;s per sample<th>error, %<th>mean, %<th>mean in the tent, %<th>memory, MB<th>file, MB",
        "<th>model, s<th>load, s<th>",
    ]
    for row in rows:
        error = "exact" if row["exact"] else (percent(row["error"]) if row["resolved"] else "&lt; " + percent(row["limit"]))
        mean, tent_mean = (
            "" if row["exact"] else f"{100 * row[light + 'mean_error']:+.2g} &plusmn; {100 * row[light + 'mean_error_se']:.2g}"
            for light in ("", "tent_")
        )
        text.append(
            f"<tr{' class=front' if row['front'] else ''}><td>{html.escape(row['scene'])}<td>{html.escape(row['choice'])}"
            f"<td>{html.escape(row['variant'])}<td>{row['cost_s']:.3g} &plusmn; {row['cost_se']:.1g}"
            f"<td>{row['relative_cost']:.2f}<td>{row['processor_us_per_sample']:.1f}<td>{error}<td>{mean}<td>{tent_mean}"
            f"<td>{row['memory_bytes'] / 1e6:.1f}<td>{row['file_bytes'] / 1e6:.1f}<td>{row['build_s']:.2g}<td>{row['load_s']:.2g}"
            f"<td><details><summary>command</summary><code>{html.escape(row['command'])}</code></details>"
        )
    text.append("</table></html>\n")
    target.write_text("\n".join(text))


def main():
    choices = pathlib.Path(sys.argv[2])
    time = choices.with_name(choices.stem + "_time.png")
    rows = read(sys.argv[1])
    plot_choices(rows, choices)
    plot_time(rows, time)
    write_page(rows, choices, time, choices.with_suffix(".html"))


main()
