#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes ring.ply: a ring with a bezel for an oval cabochon of 10 x 8 mm whose flat back lies at z = 0. Millimetres, Z up, the
finger goes along Y. Wall and seat of the bezel reach a little into the stone, as in a real setting there is no gap. Usage:
  make_ring.py OUT.ply
"""
import math
import struct
import sys

STONE_A, STONE_B = 5.0, 4.0  # half axes of the stone's outline
INNER_RADIUS = 8.6           # of the shank: a finger of 54 mm
vertices, triangles = [], []


def add_grid(rows, closed_rows=True, closed_columns=True):
    """Quads between neighbouring points of a grid, cut into triangles; outward where columns run to the left of rows."""
    first = len(vertices)
    height, width = len(rows), len(rows[0])
    for row in rows:
        vertices.extend(row)
    for i in range(height if closed_rows else height - 1):
        for j in range(width if closed_columns else width - 1):
            a, b = first + i * width + j, first + i * width + (j + 1) % width
            c, d = first + (i + 1) % height * width + j, first + (i + 1) % height * width + (j + 1) % width
            triangles.append((a, c, b))
            triangles.append((b, c, d))


def offset_ellipse(angle, offset):
    """A point of the stone's outline moved outward by `offset`."""
    x, y = STONE_A * math.cos(angle), STONE_B * math.sin(angle)
    nx, ny = math.cos(angle) / STONE_A, math.sin(angle) / STONE_B
    size = math.hypot(nx, ny)
    return x + offset * nx / size, y + offset * ny / size


def add_swept(profile, steps=128):
    """A closed profile of (offset, z), counter-clockwise with the outside to the right, once around the outline."""
    rows = []
    for i in range(steps):
        angle = 2.0 * math.pi * i / steps
        rows.append([(*offset_ellipse(angle, offset), z) for offset, z in profile])
    add_grid([list(row) for row in rows])


def add_shank(steps=128, around=24):
    """A band that widens towards the stone, rounded outside, flatter inside."""
    center_z = -INNER_RADIUS - 1.0
    rows = []
    for i in range(steps):
        angle = 2.0 * math.pi * i / steps  # 0: at the stone
        rise = 0.5 + 0.5 * math.cos(angle)
        half_width, thickness = 1.1 + 1.3 * rise**3, 1.5 + 0.5 * rise
        row = []
        for j in range(around):
            turn = 2.0 * math.pi * j / around
            c, s = math.cos(turn), math.sin(turn)
            # A superellipse: between a circle and a rectangle.
            y = half_width * math.copysign(abs(s) ** 0.75, s)
            r = INNER_RADIUS + 0.5 * thickness * (1.0 + math.copysign(abs(c) ** 0.75, c))
            row.append((r * math.sin(angle), y, center_z + r * math.cos(angle)))
        rows.append(row)
    add_grid(rows)


def add_bead(center, radius, rows=7, columns=12):
    first = len(vertices)
    cx, cy, cz = center
    vertices.append((cx, cy, cz + radius))
    for i in range(1, rows):
        theta = math.pi * i / rows
        for j in range(columns):
            phi = 2.0 * math.pi * j / columns
            vertices.append((cx + radius * math.sin(theta) * math.cos(phi), cy + radius * math.sin(theta) * math.sin(phi),
                             cz + radius * math.cos(theta)))
    vertices.append((cx, cy, cz - radius))
    last = len(vertices) - 1
    ring = lambda i, j: first + 1 + (i - 1) * columns + j % columns
    for j in range(columns):
        triangles.append((first, ring(1, j), ring(1, j + 1)))
        triangles.append((last, ring(rows - 1, j + 1), ring(rows - 1, j)))
        for i in range(1, rows - 1):
            triangles.append((ring(i, j), ring(i + 1, j), ring(i, j + 1)))
            triangles.append((ring(i, j + 1), ring(i + 1, j), ring(i + 1, j + 1)))


def add_plate(offset, low, high, steps=128):
    """The seat under the stone: an oval disc."""
    first = len(vertices)
    for z in (low, high):
        for i in range(steps):
            vertices.append((*offset_ellipse(2.0 * math.pi * i / steps, offset), z))
    bottom, top = len(vertices), len(vertices) + 1
    vertices.extend([(0.0, 0.0, low), (0.0, 0.0, high)])
    for i in range(steps):
        j = (i + 1) % steps
        triangles.append((first + i, first + j, first + steps + i))
        triangles.append((first + j, first + steps + j, first + steps + i))
        triangles.append((bottom, first + j, first + i))
        triangles.append((top, first + steps + i, first + steps + j))


def rounded_lip():
    """From the foot up the outside, over the rounded lip, down inside the stone."""
    profile = [(0.55, -1.1), (0.62, -0.9), (0.62, 0.2), (0.56, 0.9)]
    for i in range(9):
        angle = math.pi * i / 8.0
        profile.append((0.16 + 0.36 * math.cos(angle), 1.15 + 0.32 * math.sin(angle)))
    return profile + [(-0.3, 0.5), (-0.3, -1.1)]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    add_shank()
    add_swept(rounded_lip())
    add_plate(0.3, -1.1, 0.05)
    beads = 44
    for i in range(beads):
        x, y = offset_ellipse(2.0 * math.pi * (i + 0.5) / beads, 0.68)
        add_bead((x, y, -0.85), 0.33)
    with open(sys.argv[1], "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
                    f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        for vertex in vertices:
            file.write(struct.pack("<3f", *vertex))
        for triangle in triangles:
            file.write(struct.pack("<B3i", 3, *triangle))


main()
