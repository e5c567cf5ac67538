"""Runs inside Blender with a window and simulated events: an artist's first minutes with a cube, a mug and Suzanne."""

import bpy
from artist import prepare, press, seen, then
from repository import ROOT
from running import run
from screen import area, inside

MUG = ROOT / "blend_examples" / "mug.blend"


def mug():
    with bpy.data.libraries.load(str(MUG)) as (stored, wanted):
        wanted.objects = stored.objects
    for obj in wanted.objects:
        bpy.context.scene.collection.objects.link(obj)
        while obj.data.uv_layers:
            obj.data.uv_layers.remove(obj.data.uv_layers[0])
    wanted.objects[0].name = "Mug"


def cube():
    yield from press("cube", "Cube")
    yield from then("cube tiled", "Cube", bpy.ops.uv.holomorphic_tile)


def mug_and_monkey():
    for make, name in ((mug, "Mug"), (bpy.ops.mesh.primitive_monkey_add, "Suzanne")):
        with inside(area("VIEW_3D")):
            make()
        yield from press(name.lower(), name)


run((prepare, cube, mug_and_monkey), seen)
