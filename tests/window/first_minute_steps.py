"""Runs inside Blender with a window and simulated events: an artist's first minute, in solid view without textures."""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
from objects import maps, pick, spikes
from running import run
from screen import area, hover, inside, picture, window
from sidebar import count_draws, open_tab, press_button

PATIENCE = 60  # seconds for a tiling
seen = {}


def shading():
    return area("VIEW_3D").spaces.active.shading


def look_at(name):
    for obj in bpy.data.objects:
        obj.hide_set(obj.name != name)
    pick(name)
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITLEFT")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message=name)
    hover(area("VIEW_3D"))


def prepare():
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.smooth_view = 0
    window().workspace = bpy.data.workspaces["Layout"]
    yield 2
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    with inside(area("VIEW_3D")):
        bpy.ops.mesh.primitive_monkey_add()
    spikes("Spikes")
    area("VIEW_3D").spaces.active.show_region_ui = True
    shading().type, shading().color_type = "SOLID", "MATERIAL"
    count_draws(bpy.types.HOLOMORPH_PT_view3d, "VIEW_3D")
    yield 1
    yield from open_tab("VIEW_3D", seen)


def the_button():
    look_at("Suzanne")
    yield 1
    picture("first_before.png")
    yield from press_button("VIEW_3D")
    for _ in range(10 * PATIENCE):
        yield 0.1
        if maps("Suzanne"):
            break
    yield 2
    seen["shading after the button"] = [shading().type, shading().color_type]
    picture("first_after.png")


def coarse_places():
    look_at("Spikes")
    with inside(area("VIEW_3D")):
        bpy.ops.uv.holomorphic_maps(main="BALANCED")
    seen["places"] = json.loads(bpy.data.objects["Spikes"]["holomorph_report"])["coarse_places"]
    yield 2
    picture("first_coarse.png")


def materials_restored():
    for name in ("Spikes", "Suzanne"):
        bpy.data.objects["Suzanne"].hide_set(False)
        pick(name)
        with inside(area("VIEW_3D")):
            bpy.ops.uv.holomorphic_restore_materials()
    yield 1
    seen["shading at the end"] = [shading().type, shading().color_type]
    picture("first_restored.png")


def steps():
    for part in (prepare, the_button, coarse_places, materials_restored):
        yield from part()


run(steps(), seen)
