#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Computes formats/rgb_basis.cpp: needs numpy and scipy, run by hand (python3 formats/generate_rgb_basis.py).

Three reflectances at 48 nodes (360, 370 ... 830 nm, linear between), the smoothest (least squared differences) with
  - values in [0, 1] that sum to 1 at every wavelength,
  - exact sRGB primaries under D65 for the CIE 1931 observer (1 nm sums).
The idea of such a decomposition: Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance".
"""
import pathlib
import re

import numpy as np
from scipy.optimize import minimize

here = pathlib.Path(__file__).parent
numbers = lambda text: np.array([float(x) for x in re.findall(r"[-+0-9.e]+(?=f)", text)])
source = (here / "cie_tables.cpp").read_text()
observer_text, d65_text = source.split("cie_d65_5nm")
observer = numbers(observer_text.split("cie_1931_observer")[1]).reshape(471, 3)
d65_5nm = numbers(d65_text)

wavelength_nm = np.arange(360.0, 831.0)
nodes = np.arange(360.0, 831.0, 10.0)
n = len(nodes)
hat = np.maximum(0.0, 1.0 - np.abs(wavelength_nm[:, None] - nodes[None, :]) / 10.0)
d65 = np.interp(wavelength_nm, np.arange(300.0, 831.0, 5.0), d65_5nm)
xyz_from_reflectance = (observer.T * d65) @ hat / (observer[:, 1] * d65).sum()

white = xyz_from_reflectance.sum(1)
primaries = np.array([[x / y, 1.0, (1.0 - x - y) / y] for x, y in ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))]).T
xyz_from_rgb = primaries * np.linalg.solve(primaries, white)

difference = np.diff(np.eye(n), axis=0)
roughness = np.kron(np.eye(3), difference.T @ difference)
equalities = np.vstack([np.kron(np.eye(3), xyz_from_reflectance), np.kron(np.ones((1, 3)), np.eye(n))])
targets = np.concatenate([xyz_from_rgb.T.reshape(-1), np.ones(n)])
u, singular, vt = np.linalg.svd(equalities)
rank = int((singular > 1e-9 * singular[0]).sum())
particular = vt[:rank].T @ ((u[:, :rank].T @ targets) / singular[:rank])
free = vt[rank:].T
solution = minimize(
    lambda z: 0.5 * (particular + free @ z) @ roughness @ (particular + free @ z),
    np.zeros(free.shape[1]),
    jac=lambda z: free.T @ (roughness @ (particular + free @ z)),
    constraints=[{"type": "ineq", "fun": lambda z: particular + free @ z, "jac": lambda z: free}],
    method="SLSQP",
    options={"maxiter": 500, "ftol": 1e-14},
)
assert solution.success, solution.message
basis = np.clip((particular + free @ solution.x).reshape(3, n), 0.0, 1.0)
basis /= basis.sum(0)

lines = ["// SPDX-License-Identifier: Apache-2.0", '#include "formats/rgb_basis.h"', "", "namespace opal {", ""]
lines.append("const std::array<std::array<float, 48>, 3> rgb_basis_10nm = {{")
literal = lambda v: "%.9gf" % v if "." in "%.9g" % v or "e" in "%.9g" % v else "%.9g.0f" % v
for row in basis:
    lines.append("    {{")
    for i in range(0, n, 8):
        lines.append("        " + ", ".join(literal(v) for v in row[i : i + 8]) + ",")
    lines.append("    }},")
lines += ["}};", "", "}  // namespace opal", ""]
(here / "rgb_basis.cpp").write_text("\n".join(lines))
