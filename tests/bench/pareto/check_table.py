#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold of any table and chart that `opal-bench pareto -o DIR` leaves.

usage: check_table.py DIR
"""
import collections
import csv
import math
import pathlib
import sys

WORDS = ("scene", "choice", "variant", "command")


def check(folder):
    choices = collections.defaultdict(list)
    for row in csv.DictReader(open(folder / "pareto.csv")):
        for key, value in row.items():
            if key not in WORDS:
                row[key] = float(value)
                assert math.isfinite(row[key]), (row, key)
        assert "opal-model build" in row["command"] and ("opal-render" in row["command"] or "opal-bench" in row["command"]), row
        assert row["cost_s"] > 0.0 and row["processor_us_per_sample"] > 0.0 and row["memory_bytes"] > 0.0, row
        choices[row["scene"], row["choice"]].append(row)
    assert len(choices) > 20, len(choices)
    for name, rows in choices.items():
        exact = [row for row in rows if row["exact"]]
        assert len(exact) == 1, name
        assert exact[0]["squared_error"] == 0.0 and exact[0]["mean_error"] == 0.0, name

    # Without diffraction a black opal is dark, whatever the light; the source's settings show it so.
    black = {row["variant"]: row for row in choices["precious_opal", "diffraction"]}
    source = next(row for row in choices["precious_opal", "all together"] if row["variant"].startswith("source"))
    for row in (black["none"], source):
        for light in ("", "tent_"):
            # Standard errors from few seeds are uncertain themselves; the seeds are fixed, so are the errors.
            assert row[light + "mean_error"] < min(-0.2, -3.0 * row[light + "mean_error_se"]), (light, row)
    # The same walk by another method, the same surfaces by another, and the same scene turned, are not that.
    same = (("grains", "sphere tracing"), ("precision", "single, own tree"), ("precision", "single, scene turned by 37 degrees"))
    for choice, variant in same:
        row = next(row for row in choices["precious_opal", choice] if row["variant"] == variant)
        assert abs(row["tent_mean_error"]) < 0.02, row

    for name in ("pareto.png", "pareto_time.png", "pareto.html"):
        assert (folder / name).stat().st_size > 20_000, name
    page = (folder / "pareto.html").read_text()
    assert page.count("<tr") == 1 + sum(len(rows) for rows in choices.values())


check(pathlib.Path(sys.argv[1]))
