# SPDX-License-Identifier: Apache-2.0
"""Runs in Blender: what it makes of a box of 6 x 4 x 2 mm (x and y centred, z from 0) with voxels of 0.1 mm.

Arguments after --: folder of import_opal.py, the box's .vdb, its section at z = 1 mm from opal-model, a folder for pictures."""

import os
import sys

import bpy
from mathutils import Vector

example_folder, vdb_file, section_file, folder = sys.argv[sys.argv.index("--") + 1:]
sys.path.insert(0, example_folder)
import import_opal  # noqa: E402

VOXEL_MM = 0.1
LOW, HIGH = Vector((-3.0, -2.0, 0.0)), Vector((3.0, 2.0, 2.0))
PIXEL_MM = 0.025


def require(truth, message):
    if not truth:
        raise AssertionError(message)
    print("ok: " + message)


def close(a, b, tolerance):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b))


def load_pixels(path):
    """Rows from the top, each a list of (r, g, b) from 0 to 1."""
    image = bpy.data.images.load(path)
    width, height = image.size
    values = list(image.pixels)
    rows = [[tuple(values[4 * (y * width + x):4 * (y * width + x) + 3]) for x in range(width)] for y in range(height)]
    rows.reverse()
    return rows


def take_picture(name, center, axis, width, height, pixel_mm):
    """A parallel view along z from above (axis 2) or along y from the front (axis 1), without any light."""
    scene = bpy.context.scene
    for old in [thing for thing in bpy.data.objects if thing.type == "CAMERA"]:
        bpy.data.objects.remove(old)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = max(width, height) * pixel_mm
    view = Vector((0.0, 0.0, 1.0)) if axis == 2 else Vector((0.0, -1.0, 0.0))
    camera.location = center + 20.0 * view
    camera.rotation_euler = (0.0, 0.0, 0.0) if axis == 2 else (1.5707963267948966, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = (0.0, 0.0, 0.0)
    path = os.path.join(folder, name)
    import_opal.render(path, 1)
    return load_pixels(path)


def silhouette_shader():
    """White wherever Blender finds the level set negative."""
    material = bpy.data.materials.new("silhouette")
    material.use_nodes = True
    nodes = import_opal.Nodes(material.node_tree)
    inside = nodes.math("LESS_THAN", nodes.attribute("shape").outputs["Fac"], 0.0)
    medium = nodes.add("ShaderNodeVolumePrincipled")
    nodes.link(nodes.math("MULTIPLY", inside, 100.0), medium.inputs["Density"])
    nodes.link(nodes.math("MULTIPLY", inside, 100.0), medium.inputs["Emission Strength"])
    nodes.link(medium.outputs[0], nodes.add("ShaderNodeOutputMaterial").inputs["Volume"])
    return material


def silhouette_middle(pixels):
    """Middle of the bright pixels' extent in pixels from the picture's middle, x to the right, y up; and the extent."""
    height, width = len(pixels), len(pixels[0])
    columns = [sum(pixels[y][x][1] for y in range(height)) for x in range(width)]
    rows = [sum(pixel[1] for pixel in row) for row in pixels]

    def extent(sums):
        half, n = 0.5 * max(sums), len(sums)
        first = next(i for i in range(n) if sums[i] >= half)
        last = next(i for i in reversed(range(n)) if sums[i] >= half)
        return first, last + 1

    left, right = extent(columns)
    top, bottom = extent(rows)
    return 0.5 * (left + right - width), 0.5 * (height - top - bottom), right - left, bottom - top


def framed_part(page):
    """The part of a section's page inside its grey frame."""
    def is_frame(pixel):
        return all(abs(channel - 0.6) < 0.01 for channel in pixel)

    for y, row in enumerate(page):
        run = [x for x, pixel in enumerate(row) if is_frame(pixel)]
        if len(run) > 100:
            left, right, top = run[0], run[-1], y
            break
    bottom = next(y for y in range(top + 1, len(page)) if is_frame(page[y][(left + right) // 2]))
    return [row[left + 1:right] for row in page[top + 1:bottom]]


def matching_fraction(ours, theirs):
    """Of the pixels inside of grains, away from lines in both pictures: how many have the same colour."""
    same = compared = 0
    for y in range(2, len(ours) - 2, 2):
        for x in range(2, len(ours[0]) - 2, 2):
            around = [(ours[y + j][x + i], theirs[y + j][x + i]) for i in (-2, 0, 2) for j in (-2, 0, 2)]
            flat = all(close(a, ours[y][x], 0.02) and close(b, theirs[y][x], 0.02) for a, b in around)
            saturated = max(ours[y][x]) - min(ours[y][x]) > 0.2 and max(theirs[y][x]) > 0.2
            if flat and saturated:
                compared += 1
                same += close(ours[y][x], theirs[y][x], 0.06)
    return (same / compared if compared else 0.0), compared


for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
opal, low, high = import_opal.import_opal(vdb_file, cut_axis=2)
grids = {grid.name: grid for grid in opal.data.grids}
print("grids: " + ", ".join("%s (%s)" % (name, grid.data_type) for name, grid in grids.items()))
for name, kind in (("grain_id", "INT"), ("shape", "FLOAT"), ("sites", "POINTS")):
    require(name in grids and grids[name].data_type == kind, "grid %s is there, of type %s" % (name, kind))
for name in ("grain_id", "shape"):
    matrix = grids[name].matrix_object
    require(close(matrix.to_scale(), (VOXEL_MM,) * 3, 1e-6) and close(matrix.to_translation(), (0.0,) * 3, 1e-6),
            "grid %s has voxels of %g units and no offset" % (name, VOXEL_MM))
require(close(low, LOW, 1e-4) and close(high, HIGH, 1e-4), "the imported surface spans the recipe's box, in mm")
metres = bpy.context.scene.unit_settings.scale_length * (high.x - low.x)
require(abs(metres - 0.006) < 1e-6, "its longest side is 6 mm to Blender")

# As the file lies there, Blender shows it half a voxel further along each axis: its mesh and its render.
placed = opal.location.copy()
opal.location = (0.0, 0.0, 0.0)
bpy.context.view_layer.update()
raw_low, raw_high = import_opal.bounds_mm(bpy.data.objects[opal.name + "_surface"])
half = Vector((0.5 * VOXEL_MM,) * 3)
require(close(raw_low - LOW, half, 1e-4) and close(raw_high - HIGH, half, 1e-4), "unplaced, its mesh lies half a voxel too far")
opal_material = opal.data.materials[0]
opal.data.materials[0] = silhouette_shader()
center = 0.5 * (LOW + HIGH)
for axis, up in ((2, 1), (1, 2)):
    pixels = take_picture("silhouette%d.png" % axis, center, axis, 280, 200, PIXEL_MM)
    x, y, width, height = silhouette_middle(pixels)
    print("silhouette along %s: middle %.4f, %.4f mm, extent %.3f x %.3f mm" %
          ("xyz"[axis], x * PIXEL_MM, y * PIXEL_MM, width * PIXEL_MM, height * PIXEL_MM))
    require(abs(x * PIXEL_MM - half.x) <= 0.5 * PIXEL_MM and abs(y * PIXEL_MM - half[up]) <= 0.5 * PIXEL_MM,
            "unplaced, its render lies half a voxel too far (x and %s)" % "xyz"[up])
    require(abs(width * PIXEL_MM - 6.0) <= PIXEL_MM and abs(height * PIXEL_MM - (HIGH - LOW)[up]) <= PIXEL_MM,
            "its silhouette is 6 x %g mm" % (HIGH - LOW)[up])
opal.location = placed

# The grains, cut at z = 1 mm and seen from above, against the section that opal-model draws of the same place.
ours = framed_part(load_pixels(section_file))
height, width = len(ours), len(ours[0])
import_opal.GLOW = 1.0
for grain_grid in [name for name in import_opal.GRAIN_GRIDS if name in grids]:
    opal.data.materials[0] = import_opal.opal_material([grain_grid], VOXEL_MM, "grain", (2, 1.0))
    theirs = take_picture(grain_grid + ".png", center, 2, width, height, 6.0 * 1.06 / width)
    fraction, compared = matching_fraction(ours, theirs)
    mirrored, _ = matching_fraction(ours, [list(reversed(row)) for row in theirs])
    print("%s: %.2f %% of %d pixels as in the section; mirrored %.2f %%" %
          (grain_grid, 100.0 * fraction, compared, 100.0 * mirrored))
    require(compared > 2000 and fraction > 0.99, "%s: the grains lie where opal-model's section has them" % grain_grid)
    require(mirrored < 0.5, "%s: a mirrored picture would be noticed" % grain_grid)
print("all checks passed")
