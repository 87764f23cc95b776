#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables and charts of the optics of planes: runs opal-optics, compares with the reference values in tests/optics, prints the tables
as Markdown and writes optics_*.png beside this file. Needs matplotlib (Debian: python3-matplotlib).

    docs/validation/plot_optics.py [--opal-optics build/release/bin/opal-optics]
"""
import argparse
import csv
import math
import pathlib
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
REFERENCE = HERE.parent.parent / "tests" / "optics"
DIAMETER_NM = 250.0


def run(program, *arguments):
    """Columns of the table that opal-optics prints, by name."""
    text = subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(text.splitlines()))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def read_reference(name):
    with open(REFERENCE / name, encoding="utf-8") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def crystal(n_sphere, n_medium, mean="linear", diameter_nm=DIAMETER_NM):
    return ["--sphere-diameter-nm", diameter_nm, "--n-sphere", n_sphere, "--n-medium", n_medium, "--index-mean", mean]


def save(figure, name):
    figure.tight_layout()
    figure.savefig(HERE / f"optics_{name}.png", dpi=110)
    plt.close(figure)


def stop_bands(program):
    mpb = read_reference("mpb_fcc_L_gap.csv")
    print("| n_sphere / n_medium | centre / d, MPB | linear | Maxwell Garnett | nearer | width, MPB | width here | deviation |")
    print("|---|---|---|---|---|---|---|---|")
    rows = zip(mpb["n_sphere"], mpb["n_medium"], mpb["lambda_mid_over_D"], mpb["rel_gap_mpb"])
    for n_sphere, n_medium, middle, width in rows:
        deviation = {}
        for mean in ("linear", "maxwell-garnett"):
            peak = run(program, "bragg", *crystal(n_sphere, n_medium, mean), "--angle-deg", 0)
            deviation[mean] = peak["wavelength_nm"][0] / DIAMETER_NM / middle - 1.0
        here = peak["relative_width"][0]
        apart = abs(deviation["linear"]) - abs(deviation["maxwell-garnett"])
        nearer = "the same" if abs(apart) < 1e-5 else ("linear" if apart < 0 else "Maxwell Garnett")
        print(f"| {n_sphere:g} / {n_medium:g} | {middle:.5f} | {100 * deviation['linear']:+.3f} % "
              f"| {100 * deviation['maxwell-garnett']:+.3f} % | {nearer} | {100 * width:.4f} % | {100 * here:.4f} % "
              f"| {100 * (here / width - 1):+.2f} % |")


def peak_of(x, y):
    """Place, height and full width at half height over the place."""
    top = max(range(len(y)), key=y.__getitem__)
    half = 0.5 * y[top]
    low = high = top
    while y[low - 1] > half:
        low -= 1
    while y[high + 1] > half:
        high += 1

    def crossing(inside, outside):
        return x[inside] + (y[inside] - half) / (y[inside] - y[outside]) * (x[outside] - x[inside])

    return x[top], y[top], (crossing(high, high + 1) - crossing(low, low - 1)) / x[top]


def slab_in_air(program):
    fdtd = read_reference("fdtd_slab_111_ns1.45_nm1.0_12layers.csv")
    order = sorted(range(len(fdtd["reflectance"])), key=fdtd["wavelength_over_D"].__getitem__)
    x = [fdtd["wavelength_over_D"][i] for i in order]
    y = [fdtd["reflectance"][i] for i in order]
    wavelengths = ",".join(f"{DIAMETER_NM * value:.8g}" for value in x)
    curves = {"full-wave (FDTD), ambient air": y}
    for model, mean in (("two-beam", "linear"), ("two-beam", "maxwell-garnett"), ("transfer-matrix", "permittivity")):
        table = run(program, "reflectance", *crystal(1.45, 1.0, mean), "--layers", 12, "--model", model, "--wavelength-nm", wavelengths)
        curves[f"{model}, {mean}" if model == "two-beam" else f"{model}, ambient of the mean index"] = table["reflectance_s"]
    table = run(program, "reflectance", *crystal(1.45, 1.0), "--layers", 12, "--model", "transfer-matrix", "--ambient", "medium",
                "--wavelength-nm", wavelengths)
    curves["transfer-matrix, whole spheres in air"] = table["reflectance_s"]
    print("\n| 12 layers, 1.45 in air | peak at / d | height | full width at half height |")
    print("|---|---|---|---|")
    figure, axes = plt.subplots(figsize=(7, 4))
    for name, curve in curves.items():
        place, height, width = peak_of(x, curve)
        print(f"| {name} | {place:.4f} | {height:.4f} | {width:.4f} |")
        axes.plot(x, curve, "k." if name.startswith("full") else "-", markersize=3, label=name)
    axes.set(xlabel="wavelength / sphere diameter", ylabel="reflectance", title="12 (111) layers of spheres 1.45 in air", ylim=(0, 0.9))
    axes.legend(fontsize=7, ncol=2, loc="upper center")
    save(figure, "fdtd")


def rms_difference(program, n_medium, layers, angle_deg, angle_in):
    """Of s and p between two-beam theory and the transfer matrix, over four bands around the Bragg wavelength."""
    # Only wavelength over diameter matters; large spheres keep the wavelengths of steep angles among those that the flags allow.
    medium = crystal(1.45, n_medium, "permittivity", 500.0)
    filling = math.pi / (3.0 * math.sqrt(2.0))
    index = math.sqrt(filling * 1.45**2 + (1.0 - filling) * n_medium**2)
    sine = math.sin(math.radians(angle_deg)) / (index if angle_in == "outside" else 1.0)
    cosine = math.sqrt(1.0 - sine * sine)
    straight = run(program, "bragg", *medium, "--angle-deg", 0)
    peak = straight["wavelength_nm"][0] * cosine
    band = peak * straight["relative_width"][0] / cosine**2
    wavelengths = f"{peak - 2 * band:.8f}:{peak + 2.001 * band:.8f}:{band / 50:.8f}"
    curves = [run(program, "reflectance", *medium, "--layers", layers, "--angle-deg", angle_deg, "--angle-in", angle_in,
                  "--wavelength-nm", wavelengths, "--model", model) for model in ("two-beam", "transfer-matrix")]

    def rms(column):
        pairs = list(zip(curves[0][column], curves[1][column]))
        return math.sqrt(sum((a - b)**2 for a, b in pairs) / len(pairs))

    return rms("reflectance_s"), rms("reflectance_p")


def against_transfer_matrix(program):
    layer_counts = (10, 24, 50, 100, 200)
    angles = (0, 10, 20, 30, 40, 50, 60)
    figure, panels = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    print("\n| largest RMS difference, s and p | " + " | ".join(f"{n} layers" for n in layer_counts) + " |")
    print("|---|" + "---|" * len(layer_counts))
    for axes, angle_in in zip(panels, ("outside", "inside")):
        for n_medium, color in ((1.0, "tab:red"), (1.333, "tab:blue"), (1.40, "tab:green")):
            worst = {}
            for layers in layer_counts:
                differences = {angle: rms_difference(program, n_medium, layers, angle, angle_in) for angle in angles}
                worst[layers] = max((max(pair), angle) for angle, pair in differences.items())
            print(f"| n_medium {n_medium:g}, 0-60 deg {angle_in} | " +
                  " | ".join(f"{worst[n][0]:.4f} ({worst[n][1]} deg)" for n in layer_counts) + " |")
            axes.loglog(layer_counts, [worst[n][0] for n in layer_counts], "o-", color=color, label=f"n_medium {n_medium:g}")
        axes.axhline(0.015, color="grey", linestyle=":", label="0.015")
        axes.set(xlabel="layers", title=f"worst of s and p, 0 to 60 degrees {angle_in}")
        axes.set_xticks(layer_counts, [str(n) for n in layer_counts])
        axes.minorticks_off()
    panels[0].set_ylabel("RMS difference of reflectance")
    panels[0].legend(fontsize=8)
    save(figure, "two_beam_rms")


def models_side_by_side(program):
    figure, axes = plt.subplots(figsize=(7.5, 4.2))
    wavelengths = "555:605:0.1"
    common = ["reflectance", *crystal(1.45, 1.333), "--wavelength-nm", wavelengths]
    for label, arguments in (
            ("two-beam", ["--layers", 24]),
            ("transfer matrix", ["--layers", 24, "--model", "transfer-matrix"]),
            ("Laue (kinematic)", ["--layers", 24, "--model", "laue"]),
            ("Ewald-Fresnel, tolerance 1e-2", ["--model", "ewald-fresnel"]),
            ("Ewald-Fresnel, tolerance 1e-3", ["--model", "ewald-fresnel", "--tolerance", "1e-3"])):
        table = run(program, *common, *arguments)
        axes.plot(table["wavelength_nm"], table["reflectance"], label=label, linestyle="--" if "matrix" in label else "-")
    axes.set(yscale="log", ylim=(1e-4, 1))
    axes.set(xlabel="wavelength (nm)", ylabel="reflectance", title="24 (111) layers, 250 nm spheres 1.45 in 1.333, normal incidence")
    axes.legend(fontsize=8)
    save(figure, "models")


def piles(program):
    figure, axes = plt.subplots(figsize=(7, 4))
    for blocks in (1, 3, 10, 50, 200):
        table = run(program, "reflectance", *crystal(1.45, 1.333), "--layers", 24, "--blocks", blocks, "--wavelength-nm", "540:620:0.2")
        axes.plot(table["wavelength_nm"], table["reflectance"], label=f"{blocks} block" + ("s" if blocks > 1 else ""))
    axes.set(xlabel="wavelength (nm)", ylabel="reflectance", title="Pile of blocks of 24 (111) layers without interference between them")
    axes.legend(fontsize=8)
    save(figure, "pile")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--opal-optics", default=HERE.parent.parent / "build" / "release" / "bin" / "opal-optics")
    program = parser.parse_args().opal_optics
    stop_bands(program)
    slab_in_air(program)
    against_transfer_matrix(program)
    models_side_by_side(program)
    piles(program)
    subprocess.run([program, "bragg", "--sphere-diameter-nm", "150:350:10", "--angle-deg", "0:60:5", "--chart",
                    str(HERE / "optics_bragg_colors.png")], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
