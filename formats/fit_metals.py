#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the permittivities of the built-in metals (formats/metals.cpp) and prints them as C++.

A metal is a gas of free electrons (Drude) and a few critical points of its bands, in the form of Etchegoin, Le Ru & Meyer, "An
analytic model for the optical properties of gold", J. Chem. Phys. 125, 2006. Argument: a folder of CSV files "wavelength_nm,n,k",
as refractiveindex.info publishes them (CC0), of the papers named in METALS. The files themselves are not part of the project;
only the parameters are. Usage:
  fit_metals.py FOLDER
"""
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

VISIBLE_NM = (360.0, 830.0)
# Name, file, places (nm) of the critical points to start from: chosen by looking at where the residual stayed large.
METALS = [
    ("gold", "nk_au_johnson_christy_1972.csv", [470.0, 330.0]),
    ("silver", "nk_ag_johnson_christy_1972.csv", [310.0, 380.0]),
    ("copper", "nk_cu_johnson_christy_1972.csv", [560.0, 350.0]),
    ("platinum", "nk_pt_tselin_2024.csv", [800.0, 400.0]),
    ("rhodium", "nk_rh_weaver_1977.csv", [900.0, 400.0]),
    ("gold-silver", "nk_auag_rioux_au50ag50.csv", [400.0, 330.0]),
]


def permittivity(parameters, wavelength_nm):
    """eps_inf - 1 / (lp^2 (1/l^2 + i / (gp l))) + sum A / lc (e^ip / (1/lc - 1/l - i/g) + e^-ip / (1/lc + 1/l + i/g))."""
    x = 1.0 / wavelength_nm
    eps_inf, plasma, damping = np.exp(parameters[:3])
    eps = eps_inf - 1.0 / (plasma**2 * (x * x + 1j * x / damping))
    for amplitude, phase, place, width in parameters[3:].reshape(-1, 4):
        a, c, g = np.exp(amplitude), np.exp(-place), np.exp(-width)
        eps = eps + a * c * (np.exp(1j * phase) / (c - x - 1j * g) + np.exp(-1j * phase) / (c + x + 1j * g))
    return eps


def reflectance(n, k):
    return ((n - 1.0) ** 2 + k * k) / ((n + 1.0) ** 2 + k * k)


def fit(name, path, places_nm):
    data = np.genfromtxt(path, delimiter=",", skip_header=1)
    data = data[(data[:, 0] >= VISIBLE_NM[0] - 30.0) & (data[:, 0] <= VISIBLE_NM[1] + 70.0)]
    wavelength, n, k = data.T
    measured = (n + 1j * k) ** 2

    def residual(p):
        eps = permittivity(p, wavelength)
        index = np.sqrt(eps)
        r = reflectance(index.real, index.imag) - reflectance(n, k)
        difference = 0.05 * (eps - measured) / np.abs(measured)
        # A critical point of negative absorption anywhere would be no metal.
        return np.concatenate([r, difference.real, difference.imag, 10.0 * np.minimum(eps.imag, 0.0)])

    # What lies far outside the visible is not told apart by its tail.
    point_limits = np.array([[np.log(1.0e-3), -np.pi, np.log(250.0), np.log(100.0)], [np.log(50.0), np.pi, np.log(2000.0), np.log(1.0e4)]])
    limits = [np.concatenate([free, np.tile(points, len(places_nm))]) for free, points in
              zip(np.log([[0.5, 50.0, 500.0], [10.0, 300.0, 1.0e5]]), point_limits)]
    best = None
    for damping in (1000.0, 5000.0, 15000.0):
        for width in (500.0, 1500.0):
            start = [np.log(1.5), np.log(145.0), np.log(damping)]
            for place in places_nm:
                start += [np.log(0.8), -np.pi / 4, np.log(place), np.log(width)]
            found = least_squares(residual, start, bounds=limits, max_nfev=3000)
            if best is None or found.cost < best.cost:
                best = found
    p = best.x
    rows = p[3:].reshape(-1, 4)
    rounded = list(np.log([float(f"{v:.5g}") for v in np.exp(p[:3])]))
    print(f'    {{"{name}", {np.exp(p[0]):.5g}, {np.exp(p[1]):.5g}, {np.exp(p[2]):.5g}, {{', end="")
    texts = []
    for a, phase, place, width in rows:
        texts.append(f"{{{np.exp(a):.5g}, {phase:.5g}, {np.exp(place):.5g}, {np.exp(width):.5g}}}")
        rounded += [np.log(float(f"{np.exp(a):.5g}")), float(f"{phase:.5g}"), np.log(float(f"{np.exp(place):.5g}")),
                    np.log(float(f"{np.exp(width):.5g}"))]
    print(", ".join(texts) + "}},")
    index = np.sqrt(permittivity(np.array(rounded), wavelength))
    r = reflectance(index.real, index.imag) - reflectance(n, k)
    inside = (wavelength >= VISIBLE_NM[0]) & (wavelength <= VISIBLE_NM[1])
    print(f"// {name}: reflectance {100 * np.sqrt(np.mean(r[inside] ** 2)):.2f} % rms, {100 * np.abs(r[inside]).max():.2f} % at "
          f"most off; n by {np.abs(index.real - n)[inside].max():.3f}, k by {np.abs(index.imag - k)[inside].max():.3f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for metal, file, places in METALS:
        fit(metal, Path(sys.argv[1]) / file, places)
