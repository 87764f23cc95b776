#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lorenz-Mie against the published tables and the renderer's tables against the series, as Markdown; phase functions of the
crystal's defects beside the closed forms of the same mean cosine, as phase_functions.png beside this file. Needs matplotlib
(Debian: python3-matplotlib).

    docs/validation/plot_phase.py [--bin build/release/bin]
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
N_SPHERE, N_MEDIUM, FILLING = 1.45, 1.333, math.pi / (3.0 * math.sqrt(2.0))
N_CRYSTAL = N_MEDIUM + FILLING * (N_SPHERE - N_MEDIUM)
DIAMETER_NM, WAVELENGTH_NM = 250.0, 550.0
DRAINE_ALPHA = 1.0


def mie(program, index, *arguments):
    """Columns that opal-optics mie prints of a ball of that index in the crystal."""
    command = [program, "mie", "--sphere-diameter-nm", DIAMETER_NM, "--n-sphere", index, "--n-medium", N_CRYSTAL, *arguments]
    text = subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(text.splitlines()))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def recorded(tests, name):
    """What a unit test records, by key."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        subprocess.run([tests, f"--gtest_filter={name}", f"--gtest_output=json:{report}"], check=True, capture_output=True)
        test = json.loads(report.read_text(encoding="utf-8"))["testsuites"][0]["testsuite"][0]
    return {key: test[key].split() for key in sorted(test) if key.startswith(("miev0_", "page_a22_", "table_"))}


def published_cases(tests):
    print("| case | index | x | Q_sca published | found | g published | found |\n|---|---|---|---|---|---|---|")
    for name, (real, imaginary, x, q, g, q_found, g_found) in recorded(tests, "LorenzMie.Wiscombe1979").items():
        index = real if float(imaginary) == 0.0 else f"{real} + {imaginary} i"
        print(f"| {name.replace('_', ' ')} | {index} | {x} | {q} | {q_found} | {g} | {g_found} |")


def phase_tables(tests):
    print("\n| defect | nodes | largest deviation | mean cosine | light misplaced between wavelengths |\n|---|---|---|---|---|")
    for name, (nodes, deviation, mean_cosine, misplaced) in recorded(tests, "MiePhaseTable.HoldsTheSeries").items():
        _, diameter, particle = name.split("_")
        print(f"| {particle}, {int(diameter)} nm | {nodes} | {deviation} | {mean_cosine} | {misplaced} |")


def solve(mean_cosine, value):
    low, high = -1.0 + 1e-12, 1.0 - 1e-12
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if mean_cosine(middle) < value else (low, middle)
    return 0.5 * (low + high)


def henyey_greenstein(cosine, g):
    return (1.0 - g * g) / (4.0 * math.pi * (1.0 + g * g - 2.0 * g * cosine) ** 1.5)


def closed_forms(mean_cosine):
    """The phase functions in closed form with that mean cosine, by name."""
    alpha = DRAINE_ALPHA
    g = solve(lambda g: g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3), mean_cosine)
    k = solve(lambda k: 2 * k / 3 if abs(k) < 1e-4 else 1 / k - (1 - k * k) * math.atanh(k) / (k * k), mean_cosine)
    return {
        "Henyey-Greenstein": lambda c: henyey_greenstein(c, mean_cosine),
        f"Draine, alpha {alpha:g}": lambda c: henyey_greenstein(c, g) * (1 + alpha * c * c) / (1 + alpha * (1 + 2 * g * g) / 3),
        "Schlick": lambda c: (1 - k * k) / (4 * math.pi * (1 - k * c) ** 2),
    }


def phase_functions(program):
    figure, axes = plt.subplots(1, 3, figsize=(11.0, 3.7))
    particles = {"vacancy": N_MEDIUM, "silica sphere": N_SPHERE}
    for axis, (name, index) in zip(axes, particles.items()):
        asymmetry = mie(program, index, "--wavelength-nm", WAVELENGTH_NM)["g"][0]
        table = mie(program, index, "--wavelength-nm", WAVELENGTH_NM, "--phase", "0:180:0.5")
        angles = table["angle_deg"]
        axis.semilogy(angles, table["phase_per_sr"], color="black", lw=2.0, label="Lorenz-Mie")
        for (form, density), color in zip(closed_forms(asymmetry).items(), ("#1f77b4", "#2ca02c", "#d62728")):
            axis.semilogy(angles, [density(math.cos(math.radians(a))) for a in angles], color=color, lw=1.0, label=form)
        axis.set_title(f"{name}, {DIAMETER_NM:g} nm, at {WAVELENGTH_NM:g} nm: g = {asymmetry:.3f}", fontsize=9)
        axis.set_xlabel("scattering angle (degrees)")
        axis.set_ylabel("phase function (1/sr)")
        axis.set_ylim(1e-3, 1.0)
        axis.set_xticks(range(0, 181, 45))
        axis.legend(frameon=False, fontsize=8)
    for wavelength, color in ((450, "#1f4fd0"), (550, "#2ca02c"), (650, "#d62728")):
        table = mie(program, N_MEDIUM, "--wavelength-nm", wavelength, "--phase", "0:180:0.5")
        axes[2].semilogy(table["angle_deg"], table["phase_per_sr"], color=color, label=f"{wavelength} nm")
    axes[2].set_title("vacancy, 250 nm, over the wavelength", fontsize=9)
    axes[2].set_xlabel("scattering angle (degrees)")
    axes[2].set_ylim(1e-4, 1.0)
    axes[2].set_xticks(range(0, 181, 45))
    axes[2].legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "phase_functions.png", dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"), help="folder of the programs")
    folder = parser.parse_args().bin
    published_cases(folder / "opal_formats_tests")
    phase_tables(folder / "opal_renderer_tests")
    phase_functions(folder / "opal-optics")


if __name__ == "__main__":
    main()
