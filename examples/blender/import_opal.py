# SPDX-License-Identifier: Apache-2.0
"""Imports an opal .vdb into Blender (tested with 3.4) and shows its grains in colour.

Without a window, to a picture:   blender -b --factory-startup -P import_opal.py -- opal.vdb picture.png
Inside Blender:                   Text editor, Open, Run Script; then File > Import > Opal (.vdb)

One Blender unit is one millimetre. Blender places a grid's voxels by their lower corners where OpenVDB means their centres, so
everything is moved back by half a voxel. Blender interpolates the grains' ids between voxels: a value that is not a whole number
lies on a boundary and is drawn dark, and the outermost layer, where ids fade to the 0 outside, is not drawn.
"""

import argparse
import itertools
import math
import os
import sys

import bpy
from bpy_extras.io_utils import ImportHelper
from mathutils import Vector

bl_info = {"name": "Import opal", "blender": (3, 4, 0), "category": "Import-Export"}

METRES_PER_UNIT = 0.001
GRAIN_GRIDS = ("grain_id_float", "grain_id")  # the float twin where the file has one
DENSITY_PER_MM = 60.0  # dense enough to look solid
GLOW = 0.35  # part of the colour that needs no light, which keeps the picture free of noise
LINE_COLOR = (0.01, 0.01, 0.01, 1.0)
BLACK = (0.0, 0.0, 0.0, 1.0)


def load_volume(path):
    """A volume object with the file's grids, moved so that voxel centres lie where OpenVDB has them, and its voxel size in mm."""
    volume = bpy.data.volumes.new(os.path.splitext(os.path.basename(path))[0])
    volume.filepath = os.path.abspath(path)
    if not volume.grids.load():
        raise SystemExit("error: %s: %s" % (path, volume.grids.error_message))
    names = [grid.name for grid in volume.grids]
    for needed in ("grain_id", "shape"):
        if needed not in names:
            raise SystemExit("error: %s: no grid named %s (found: %s)" % (path, needed, ", ".join(names)))
    voxel_mm = volume.grids["shape"].matrix_object[0][0]
    volume.render.clipping = 0.0
    opal = bpy.data.objects.new(volume.name, volume)
    opal.location = Vector((-0.5 * voxel_mm,) * 3)
    bpy.context.scene.collection.objects.link(opal)
    return opal, voxel_mm


def add_surface(opal, voxel_mm):
    """The outer surface as a mesh that follows the level set, shown as a wire frame and left out of renders."""
    surface = bpy.data.objects.new(opal.name + "_surface", bpy.data.meshes.new(opal.name + "_surface"))
    bpy.context.scene.collection.objects.link(surface)
    modifier = surface.modifiers.new("surface", "VOLUME_TO_MESH")
    modifier.object = opal
    modifier.grid_name = "shape"
    modifier.threshold = 0.0
    modifier.resolution_mode = "GRID"
    surface.display_type = "WIRE"
    surface.hide_render = True
    return surface


def bounds_mm(surface):
    """Lowest and highest corner of the surface, in the world."""
    mesh_owner = surface.evaluated_get(bpy.context.evaluated_depsgraph_get())
    corners = [mesh_owner.matrix_world @ vertex.co for vertex in mesh_owner.data.vertices]
    return (Vector([min(corner[axis] for corner in corners) for axis in range(3)]),
            Vector([max(corner[axis] for corner in corners) for axis in range(3)]))


class Nodes:
    """Shorthand for building a shader's graph."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def add(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def link(self, source, target):
        if hasattr(source, "links"):
            self.tree.links.new(source, target)
        else:
            target.default_value = source

    def math(self, operation, *inputs):
        node = self.add("ShaderNodeMath", operation=operation)
        for source, target in zip(inputs, node.inputs):
            self.link(source, target)
        return node.outputs[0]

    def attribute(self, name):
        return self.add("ShaderNodeAttribute", attribute_name=name)

    def fraction_of_multiple(self, number, factor):
        return self.math("FRACT", self.math("MULTIPLY", number, factor))


def grain_color(nodes, grid_name):
    """Hue and lightness from the rounded id, the same as in opal-model section; dark where the id is between two."""
    grain_id = nodes.attribute(grid_name).outputs["Fac"]
    whole = nodes.math("ROUND", grain_id)
    hue = nodes.fraction_of_multiple(whole, 0.6180339887498949)
    lightness = nodes.math("MULTIPLY_ADD", nodes.fraction_of_multiple(whole, 0.5698402909980532), 0.27, 0.63)
    color = nodes.add("ShaderNodeCombineColor", mode="HSV")
    nodes.link(hue, color.inputs[0])
    nodes.link(0.722, color.inputs[1])
    nodes.link(lightness, color.inputs[2])
    linear = nodes.add("ShaderNodeGamma")
    nodes.link(color.outputs[0], linear.inputs["Color"])
    nodes.link(2.2, linear.inputs["Gamma"])
    on_boundary = nodes.math("GREATER_THAN", nodes.math("ABSOLUTE", nodes.math("SUBTRACT", grain_id, whole)), 0.02)
    mix = nodes.add("ShaderNodeMixRGB")
    nodes.link(on_boundary, mix.inputs["Fac"])
    nodes.link(linear.outputs[0], mix.inputs["Color1"])
    nodes.link(LINE_COLOR, mix.inputs["Color2"])
    return mix.outputs[0]


def opal_material(grid_names, voxel_mm, color_by, cut):
    """A dense coloured medium inside the level set; `cut`: (axis, place in mm) with nothing drawn on its near side, or None."""
    material = bpy.data.materials.new("opal")
    material.use_nodes = True
    nodes = Nodes(material.node_tree)
    if color_by == "orientation":
        color = nodes.attribute("orientation_rgb").outputs["Color"]
    else:
        color = grain_color(nodes, next(name for name in GRAIN_GRIDS if name in grid_names))
    # Deeper than a voxel's diagonal every value around is that of a labelled voxel.
    solid = nodes.math("LESS_THAN", nodes.attribute("shape").outputs["Fac"], -math.sqrt(3.0) * voxel_mm)
    if cut:
        axis, place_mm = cut
        position = nodes.add("ShaderNodeSeparateXYZ")
        nodes.link(nodes.add("ShaderNodeNewGeometry").outputs["Position"], position.inputs[0])
        kept_side = "LESS_THAN" if axis == 2 else "GREATER_THAN"  # seen from above, or from the axis's lower end
        solid = nodes.math("MULTIPLY", solid, nodes.math(kept_side, position.outputs[axis], place_mm))
    medium = nodes.add("ShaderNodeVolumePrincipled")
    density = nodes.math("MULTIPLY", solid, DENSITY_PER_MM)
    lit = nodes.add("ShaderNodeMixRGB")
    nodes.link(GLOW, lit.inputs["Fac"])
    nodes.link(color, lit.inputs["Color1"])
    nodes.link(BLACK, lit.inputs["Color2"])
    nodes.link(lit.outputs[0], medium.inputs["Color"])
    nodes.link(density, medium.inputs["Density"])
    nodes.link(nodes.math("MULTIPLY", density, GLOW), medium.inputs["Emission Strength"])
    nodes.link(color, medium.inputs["Emission Color"])
    nodes.link(medium.outputs[0], nodes.add("ShaderNodeOutputMaterial").inputs["Volume"])
    return material


def import_opal(path, color_by="grain", cut_axis=None):
    """Everything above for one file. Returns the volume object and the bounds of its surface in mm."""
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length, units.length_unit = "METRIC", METRES_PER_UNIT, "MILLIMETERS"
    opal, voxel_mm = load_volume(path)
    names = [grid.name for grid in opal.data.grids]
    if color_by == "orientation" and "orientation_rgb" not in names:
        raise SystemExit("error: %s: no grid named orientation_rgb; build the opal with output.for_blender = true" % path)
    surface = add_surface(opal, voxel_mm)
    low, high = bounds_mm(surface)
    cut = (cut_axis, 0.5 * (low[cut_axis] + high[cut_axis])) if cut_axis is not None else None
    opal.data.materials.append(opal_material(names, voxel_mm, color_by, cut))
    return opal, low, high


def light_and_camera(low, high, cut_axis, width, height):
    """A sun and a camera that looks at the cut, or at the front, from above, with what is drawn filling the picture."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    drawn_low, drawn_high = low.copy(), high.copy()
    if cut_axis is not None:
        (drawn_high if cut_axis == 2 else drawn_low)[cut_axis] = 0.5 * (low[cut_axis] + high[cut_axis])
    center, margin = 0.5 * (drawn_low + drawn_high), 0.55 * (drawn_high - drawn_low)
    corners = [center[axis] + margin[axis] * sign[axis]
               for sign in itertools.product((-1.0, 1.0), repeat=3) for axis in range(3)]
    views = {0: (-1.0, -0.3, 0.8), 1: (-0.15, -1.0, 1.0), 2: (-0.1, -0.7, 1.0), None: (-0.15, -1.0, 0.8)}
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 90.0
    camera.data.clip_end = 1000.0 * max(high - low)
    camera.rotation_euler = Vector(views[cut_axis]).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), corners)

    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 14.0
    sun.rotation_euler = Vector((-1.0, -1.5, 2.2)).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("background")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.9, 0.9, 0.9, 1.0)
    scene.world.cycles_visibility.scatter = False  # seen by the camera alone: light from all around would take many samples


def render(path, samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = scene.cycles.volume_bounces = 0
    scene.cycles.volume_step_rate = 1.5
    scene.cycles.seed = 1
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = os.path.abspath(path)
    bpy.ops.render.render(write_still=True)


class ImportOpal(bpy.types.Operator, ImportHelper):
    """Import an opal .vdb with its grains in colour"""

    bl_idname = "import_scene.opal"
    bl_label = "Import opal"
    filename_ext = ".vdb"
    filter_glob: bpy.props.StringProperty(default="*.vdb", options={"HIDDEN"})
    cut_open: bpy.props.BoolProperty(name="Cut open", default=True, description="Leave out the half in front")

    def execute(self, _context):
        import_opal(self.filepath, cut_axis=1 if self.cut_open else None)
        return {"FINISHED"}


def add_to_menu(menu, _context):
    menu.layout.operator(ImportOpal.bl_idname, text="Opal (.vdb)")


def register():
    bpy.utils.register_class(ImportOpal)
    bpy.types.TOPBAR_MT_file_import.append(add_to_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(add_to_menu)
    bpy.utils.unregister_class(ImportOpal)


def main(arguments):
    parser = argparse.ArgumentParser(prog="import_opal.py", description="Renders an opal .vdb's grains with Blender.")
    parser.add_argument("opal", help="opal .vdb")
    parser.add_argument("picture", help="PNG to write")
    parser.add_argument("--color", choices=("grain", "orientation"), default="grain")
    parser.add_argument("--cut", choices=("x", "y", "z", "none"), default="y",
                        help="cut the opal open in the middle across an axis (default y)")
    parser.add_argument("--samples", type=int, default=16, help="per pixel (default 16)")
    parser.add_argument("--size", type=int, nargs=2, default=(720, 420), metavar=("WIDTH", "HEIGHT"))
    options = parser.parse_args(arguments)
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    cut_axis = {"x": 0, "y": 1, "z": 2}.get(options.cut)
    _, low, high = import_opal(options.opal, options.color, cut_axis)
    light_and_camera(low, high, cut_axis, options.size[0], options.size[1])
    render(options.picture, options.samples)


if __name__ == "__main__":
    if bpy.app.background:
        main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else ["--help"])
    else:
        register()
