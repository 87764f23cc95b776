#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the bands of the built-in absorbers (formats/absorber_bands.cpp) and prints them as C++.

A spectrum is a sum of Gaussian bands over the wavenumber, the usual description of absorption bands (e.g. Demtroeder, Laser
Spectroscopy, 5th ed., section 2.3). Arguments: CSV files "wavelength_nm,value" of
  iron-oxide       absorption of dilute hematite particles, small against the wavelength, in silica (computed, Rayleigh limit)
  light-blue-dye   molar extinction of methylene blue in ethanol
  pink-dye         molar extinction of rhodamine B in ethanol (both dyes: PhotochemCAD)
The files themselves are not part of the project; only the bands are. Usage:
  fit_absorbers.py iron_oxide.csv methylene_blue.csv rhodamine_b.csv
"""
import sys

import numpy as np
from scipy.optimize import least_squares

VISIBLE_NM = (360.0, 830.0)
# Start values (nm) of the bands; numbers and places were chosen by looking at where the residual stayed large.
ABSORBERS = [
    ("iron-oxide", [360.0, 490.0, 550.0, 850.0]),
    ("light-blue-dye", [470.0, 580.0, 615.0, 650.0, 665.0]),
    ("pink-dye", [355.0, 475.0, 510.0, 527.0, 545.0]),
]
# Center and width in cm^-1, strength: what lies far outside the visible is not told apart by its tail.
LOWEST = [11000.0, 150.0, 1.0e-4]
HIGHEST = [32000.0, 6000.0, 2.0]


def bands_at(parameters, wavenumber):
    """Sum of strength exp(-((wavenumber - center) / width)^2 / 2)."""
    centers, widths, strengths = np.exp(parameters).reshape(-1, 3).T
    return (strengths * np.exp(-0.5 * ((wavenumber[:, None] - centers) / widths) ** 2)).sum(axis=1)


def fit(name, path, start_nm):
    data = np.genfromtxt(path, delimiter=",", skip_header=1)
    data = data[(data[:, 0] >= VISIBLE_NM[0]) & (data[:, 0] <= VISIBLE_NM[1])]
    wavenumber = 1.0e7 / data[:, 0]
    value = np.maximum(data[:, 1] / data[:, 1].max(), 0.0)
    # What is absorbed little decides the hue as well: errors count more where the value is small.
    weight = 1.0 / (value + 0.2)
    start = np.log([[1.0e7 / nm, 800.0, 0.3] for nm in start_nm]).ravel()
    limits = np.log([LOWEST * len(start_nm), HIGHEST * len(start_nm)])
    best = least_squares(lambda p: weight * (bands_at(p, wavenumber) - value), start, bounds=limits, max_nfev=20000)
    bands = np.exp(best.x).reshape(-1, 3)
    bands = bands[np.argsort(bands[:, 0])]
    error = bands_at(best.x, wavenumber) - value
    rms, largest = np.sqrt(np.mean(error**2)), np.abs(error).max()
    print(f"// {name}: of its largest value, {100 * rms:.2f} % rms and {100 * largest:.2f} % at most off, "
          f"{data[0, 0]:.0f} to {data[-1, 0]:.0f} nm")
    for center, width, strength in bands:
        print(f"    {{{center:.0f}.0, {width:.0f}.0, {strength:.4f}}},")
    rounded = np.log(np.column_stack([bands[:, 0].round(), bands[:, 1].round(), bands[:, 2].round(4)]).clip(1e-6)).ravel()
    print(f"// rounded to these digits: {100 * np.abs(bands_at(rounded, wavenumber) - value).max():.2f} % at most off")


if __name__ == "__main__":
    if len(sys.argv) != 1 + len(ABSORBERS):
        sys.exit(__doc__)
    for (absorber, centers), file in zip(ABSORBERS, sys.argv[1:]):
        fit(absorber, file, centers)
