# SPDX-License-Identifier: Apache-2.0
"""Reads an opal's grids with Python's OpenVDB module, as docs/formats.md says. Exit code 77: there is no such module.

Usage: read_with_python.py FILE.vdb"""
import sys

try:
    import pyopenvdb as vdb
except ImportError as error:
    print(error)
    sys.exit(77)

file = sys.argv[1]
expected = {"shape": "FloatGrid", "sigma_a_scale": "FloatGrid", "sigma_s_mie": "FloatGrid",
            "orientation_rgb": "Vec3SGrid", "grain_id_float": "FloatGrid"}
for name, kind in expected.items():
    grid = vdb.read(file, name)
    assert type(grid).__name__ == kind, f"{name} is a {type(grid).__name__}"
    assert grid.activeVoxelCount() > 0, name
    print(name, kind, grid.activeVoxelCount(), grid.transform.voxelSize()[0])

ids = vdb.read(file, "grain_id_float")
low, high = ids.evalMinMax()
assert low == 1.0 and high <= vdb.readMetadata(file)["num_grains"], (low, high)
accessor = ids.getConstAccessor()
assert accessor.getValue((0, 0, 20)) >= 1.0 and accessor.getValue((0, 0, 20)) == int(accessor.getValue((0, 0, 20)))
assert vdb.read(file, "shape").getConstAccessor().getValue((0, 0, 20)) < 0.0

# The module knows no integer grids and no points; whoever needs ids reads the float twin.
for name in ("grain_id", "sites"):
    try:
        vdb.read(file, name)
        raise SystemExit(f"{name} can be read after all: the documentation is out of date")
    except TypeError:
        pass
