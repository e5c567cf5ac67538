# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the files of blend_examples/things: examples on whose tilings something stands, to be looked at as they open.
Run it with Blender 3.4, after scripts/build (scripts/thing-examples does):

blender -b --factory-startup --python-exit-code 1 --python blend_examples/make_things.py -- PICTURES [name...]

A picture of each goes to the folder PICTURES.
"""

import sys
from pathlib import Path

import bmesh
import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from make_seamless import HERE, make_all, opened, save

from addon import compatibility
from addon.results import tags
from addon.things import geometry

FOLDER = HERE / "things"
GAP, HEIGHT = 0.05, 0.12  # of raised bricks, in lengths of their sides


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
    bmesh.ops.inset_individual(edited, faces=edited.faces[:], thickness=GAP * side, depth=HEIGHT * side)
    edited.to_mesh(mesh)
    edited.free()
    mesh.polygons.foreach_set("use_smooth", np.zeros(len(mesh.polygons), bool))
    hide(obj)
    return made


FILES = {  # example, tiles, what stands on them, colour of that and of what is below, how metallic it is
    "lizard_scales": ("lizard", 120, scales, (0.09, 0.26, 0.13), (0.05, 0.12, 0.07), 0.0),
    "armadillo_chain_mail": ("armadillo", 120, chain_mail, (0.32, 0.33, 0.36), (0.02, 0.02, 0.025), 1.0),
    "critter_knitted": ("critter", 60, knit, (0.45, 0.07, 0.05), (0.25, 0.03, 0.02), 0.0),
    "mug_wicker": ("mug", 60, wicker, (0.5, 0.33, 0.14), (0.1, 0.07, 0.04), 0.0),
    "pretzel_bricks": ("pretzel", 200, bricks, (0.42, 0.15, 0.08), (0.3, 0.28, 0.26), 0.0),
}


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


def make(name):
    example, tiles, put, color, below, metallic = FILES[name]
    obj = opened(example)
    bpy.ops.uv.holomorphic_tile(tiles=tiles, checker=False)
    made = put(obj)
    pieces = [found for found in tags.find(geometry.PIECES_OF, obj) if found != made]
    for block in pieces or [made]:
        paint(block, "Pieces", color, metallic)
    if put is wicker:
        compatibility.set_node_inputs(made.modifiers[0], {"Material": made.active_material})
    paint(obj, "Surface", below, 0.0)
    save(obj, FOLDER / f"{name}.blend")
    return [made] if obj.hide_render else [obj, made]


if __name__ == "__main__":
    make_all(FILES, FOLDER, make)
