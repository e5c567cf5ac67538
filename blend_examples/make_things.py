# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the files of blend_examples/things: examples on whose tilings something stands, to be looked at as they open.
Run it with Blender 3.4, after scripts/build (scripts/thing-examples does):

blender -b --factory-startup --python-exit-code 1 --python blend_examples/make_things.py -- PICTURES [name...]

A picture of each goes to the folder PICTURES.
"""

import sys
import tempfile
from pathlib import Path

import bmesh
import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from figures import human, vase
from make_seamless import HERE, make_all, opened, save
from modeling import select_only

from addon import compatibility
from addon.results import tags
from addon.scene import image_io
from addon.things import geometry

FOLDER = HERE / "things"
GAP, HEIGHT = 0.05, 0.12  # of raised bricks, in lengths of their sides
MORTAR = "is_mortar"  # attribute of faces
KEPT_PIXELS = 256  # of the pictures that the figure showed before the bake
PIXELS = 128  # of a picture of a knurl
DEPTH, TRIANGLES = 2.2, 20_000  # of the knurls, in millimetres, and of the vase with them
TEXELS, QUALITY = 300.0, 75  # for a metre of the figure, and of its images as JPEG files


def scales(obj):
    bpy.ops.object.holomorphic_geometry(piece="SCALE", columns=3)
    return bpy.data.objects[f"{obj.name} Geometry"]


def chain_mail(obj):
    bpy.ops.object.holomorphic_geometry(piece="RING", columns=3)
    return bpy.data.objects[f"{obj.name} Geometry"]


def knit(obj):
    bpy.ops.object.holomorphic_geometry(piece="STITCH", columns=4)
    return bpy.data.objects[f"{obj.name} Geometry"]


def hide(obj):
    obj.hide_set(True)
    obj.hide_render = True


def wicker(obj):
    bpy.ops.object.holomorphic_lines(direction="BOTH", per_tile=3)
    made = bpy.data.objects[f"{obj.name} Lines"]
    compatibility.set_node_inputs(made.modifiers[0], {"Radius": 0.013 * max(obj.dimensions), "Sides": 8})
    hide(obj)
    return made


def bricks(obj):
    bpy.ops.object.holomorphic_cells(columns=1, rows=2, shifted=True, simple=True)
    made = bpy.data.objects[f"{obj.name} Cells"]
    mesh = made.data
    edited = bmesh.new()
    edited.from_mesh(mesh)
    side = float(np.median([face.calc_area() for face in edited.faces])) ** 0.5
    is_mortar = edited.faces.layers.int.new(MORTAR)
    cells = edited.faces[:]
    for face in bmesh.ops.inset_individual(edited, faces=cells, thickness=GAP * side)["faces"]:
        face[is_mortar] = 1
    bmesh.ops.inset_individual(edited, faces=cells, thickness=0.0, depth=HEIGHT * side)
    edited.to_mesh(mesh)
    edited.free()
    mesh.polygons.foreach_set("use_smooth", np.zeros(len(mesh.polygons), bool))
    hide(obj)
    return made


def lay_mortar(mesh):
    """Faces around bricks get the second material."""
    marks = np.empty(len(mesh.polygons), np.int32)
    mesh.attributes[MORTAR].data.foreach_get("value", marks)
    mesh.attributes.remove(mesh.attributes[MORTAR])
    mesh.polygons.foreach_set("material_index", marks)


def knurls():
    """An image of pyramids that stand on their corners: in rows they are knurling."""
    x, y = np.meshgrid(*2 * [(np.arange(PIXELS) + 0.5) / PIXELS])
    ridges = [np.abs(2 * ((k * x + y) % 1) - 1) for k in (1, -1)]
    image = bpy.data.images.new("Knurls", PIXELS, PIXELS, float_buffer=True)
    image_io.write_pixels(image, np.repeat(np.clip(1.5 * np.minimum(*ridges), 0, 1)[..., None], 4, axis=2))
    return image


def knurled(obj):
    """Engraved, so that the foot stands as before."""
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length, units.length_unit = "METRIC", 0.001, "MILLIMETERS"
    bpy.ops.object.holomorphic_relief(image=knurls().name, depth=DEPTH, level=1.0, most_triangles=TRIANGLES)
    made = bpy.data.objects[f"{obj.name} Relief"]
    made.data.uv_layers.remove(made.data.uv_layers[0])  # a printer needs none
    made.data.polygons.foreach_set("use_smooth", np.zeros(len(made.data.polygons), bool))
    hide(obj)
    return made


def baked(obj):
    bpy.ops.uv.holomorphic_tile(tiles=40, texture="WEAVE")
    tiled = list(bpy.data.images)
    bpy.ops.object.holomorphic_bake(channels={"COLOUR", "NORMAL"}, texels=TEXELS)
    with tempfile.TemporaryDirectory() as folder:
        for image in list(bpy.data.images):
            image.scale(*(2 * [KEPT_PIXELS] if image in tiled else image.size))  # or it is saved as it was packed
            pack_as_jpeg(image, Path(folder) / f"{image.name}.jpg")
    return obj


def pack_as_jpeg(image, path):
    image.filepath_raw, image.file_format = str(path), "JPEG"
    image.save(quality=QUALITY)
    packed = bpy.data.images.load(str(path))
    packed.colorspace_settings.name = image.colorspace_settings.name
    packed.pack()
    packed.filepath = f"//{path.name}"
    image.user_remap(packed)
    bpy.data.images.remove(image)
    packed.name = path.stem


FILES = {  # example, or what makes one; tiles; what stands on them; colours of that and of what is below; how metallic
    "lizard_scales": ("lizard", 120, scales, (0.09, 0.26, 0.13), (0.05, 0.12, 0.07), 0.0),
    "armadillo_chain_mail": ("armadillo", 120, chain_mail, (0.32, 0.33, 0.36), (0.02, 0.02, 0.025), 1.0),
    "critter_knitted": ("critter", 60, knit, (0.45, 0.07, 0.05), (0.25, 0.03, 0.02), 0.0),
    "mug_wicker": ("mug", 60, wicker, (0.5, 0.33, 0.14), (0.1, 0.07, 0.04), 0.0),
    "pretzel_bricks": ("pretzel", 200, bricks, (0.42, 0.15, 0.08), (0.3, 0.28, 0.26), 0.0),
    "vase_knurled": (vase, 60, knurled, (0.1, 0.28, 0.3), (0.1, 0.28, 0.3), 0.0),
}
BAKED = "human_baked"


def paint(block, name, color, metallic):
    made = bpy.data.materials.new(name)
    compatibility.enable_nodes(made)
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Roughness"].default_value = 0.35
    made.diffuse_color = (*color, 1.0)
    block.data.materials.clear()
    block.data.materials.append(made)


def start(example):
    if isinstance(example, str):
        return opened(example)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = example()
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), bool))
    select_only(obj)
    return obj


def make(name):
    if name == BAKED:
        obj = baked(start(human))
        save(obj, FOLDER / f"{name}.blend")
        return [obj]
    example, tiles, put, color, below, metallic = FILES[name]
    obj = start(example)
    bpy.ops.uv.holomorphic_tile(tiles=tiles, checker=False)
    made = put(obj)
    pieces = [found for found in tags.find(geometry.PIECES_OF, obj) if found != made]
    for block in pieces or [made]:
        paint(block, "Pieces", color, metallic)
    if put is wicker:
        compatibility.set_node_inputs(made.modifiers[0], {"Material": made.active_material})
    paint(obj, "Surface", below, 0.0)
    if put is bricks:
        made.data.materials.append(obj.active_material)
        lay_mortar(made.data)
    save(obj if put is not knurled else made, FOLDER / f"{name}.blend")
    return [made] if obj.hide_render else [obj, made]


if __name__ == "__main__":
    make_all([*FILES, BAKED], FOLDER, make)
