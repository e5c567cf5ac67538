"""Runs inside Blender with a window and simulated events: an artist's first minute, in solid view without textures."""

import json

import bpy
from objects import clear, look_at, maps, pick, spikes
from running import run, wait_until
from screen import area, enter, inside, picture
from sidebar import open_sidebar, press_button

seen = {}


def shading():
    return area("VIEW_3D").spaces.active.shading


def prepare():
    yield from enter("Layout")
    clear()
    with inside(area("VIEW_3D")):
        bpy.ops.mesh.primitive_monkey_add()
    spikes("Spikes")
    shading().type, shading().color_type = "SOLID", "MATERIAL"
    yield from open_sidebar(seen)


def the_button():
    look_at("Suzanne")
    yield 0.25
    picture("first_before.png")
    yield from press_button("VIEW_3D")
    yield from wait_until(lambda: maps("Suzanne"))
    yield 0.5
    seen["shading after the button"] = [shading().type, shading().color_type]
    picture("first_after.png")


def coarse_places():
    look_at("Spikes")
    with inside(area("VIEW_3D")):
        bpy.ops.uv.holomorphic_maps(main="BALANCED")
    seen["places"] = json.loads(bpy.data.objects["Spikes"]["holomorph_report"])["coarse_places"]
    yield 0.5
    picture("first_coarse.png")


def materials_restored():
    for name in ("Spikes", "Suzanne"):
        bpy.data.objects["Suzanne"].hide_set(False)
        pick(name)
        with inside(area("VIEW_3D")):
            bpy.ops.uv.holomorphic_restore_materials()
    yield 0.25
    seen["shading at the end"] = [shading().type, shading().color_type]
    picture("first_restored.png")


run((prepare, the_button, coarse_places, materials_restored), seen)
