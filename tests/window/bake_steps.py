"""Runs inside Blender with a window and simulated events: bakes a tiling, once cancelled, once to the end, undone."""

import bpy
from objects import clear, pick, torus
from running import run, wait_until
from screen import area, hover, inside, tap

NAME = "Ring"
seen = {}


def state():
    """What a bake makes, and what of it must not be left."""
    made = [image.name for image in bpy.data.images if NAME in image.name]
    material = bpy.data.objects[NAME].material_slots[0].material.name
    others = [len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.meshes)]
    return [sorted(made), material, bpy.data.objects[NAME].data.uv_layers.keys(), others]


def begin():
    with inside(area("VIEW_3D")):
        return list(bpy.ops.object.holomorphic_bake("INVOKE_DEFAULT", texels=40.0))


def bakes():
    clear()
    torus(NAME, 24, 12, 0)
    pick(NAME)
    with inside(area("VIEW_3D")):
        bpy.ops.uv.holomorphic_tile("EXEC_DEFAULT", tiles=24, texture="BRICKS")
        bpy.ops.ed.undo_push(message="Tiled")
    yield 0.25
    seen["before"] = state()
    seen["begin"] = begin()
    hover(area("VIEW_3D"))
    tap("ESC")
    yield 0.75
    seen["after ESC"] = state()
    begin()
    yield from wait_until(lambda: state()[0])
    yield 0.25
    seen["baked"] = state()
    with inside(area("VIEW_3D")):
        bpy.ops.ed.undo()
    yield 0.25
    seen["undone"] = state()


run([bakes], seen)
