"""Runs inside Blender with a window and simulated events: tiles, uses the redo panel and its presets, drags poles."""

import importlib
import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from bpy_extras.view3d_utils import location_3d_to_region_2d
from objects import part_report, pick, torus
from running import run
from screen import area, click, event, hover, inside, move, picture, pixels, region, tap, window
from sidebar import count_draws, open_tab, press_button

PATIENCE = 60  # seconds for the texture to follow
seen = {}
NAME = "Ring"


def addon(name):
    return importlib.import_module(f"holomorph_addon.{name}")


def obj():
    return bpy.data.objects[NAME]


def uv():
    return addon("mesh_io").read_map(obj().data, "Holomorphic")


def note_stages():
    """A list of the stages that the library's jobs go through from now on."""
    work, noted = addon("jobs").Work, []
    original = work.ask

    def ask(self, fraction, stage):
        noted.append(stage)
        return original(self, fraction, stage)

    work.ask = ask
    return noted


def poles():
    vertices, is_pole = addon("tile_report").marks(obj()["holomorph_report"])
    return vertices[is_pole].tolist()


def on_screen(vertex):
    """Where a vertex is seen, in the window."""
    view = region(area("VIEW_3D"), "WINDOW")
    point = addon("mesh_io").world_points(obj(), [vertex])[0]
    place = location_3d_to_region_2d(view, area("VIEW_3D").spaces.active.region_3d, point)
    return view.x + place.x, view.y + place.y


def colour_at(name, vertex):
    x, y = on_screen(vertex)
    return pixels(name)[int(y), int(x)].tolist()


def wait_until(is_so):
    start = time.perf_counter()
    while not is_so() and time.perf_counter() - start < PATIENCE:
        yield 0.1


def prepare():
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.smooth_view = 0
    window().workspace = bpy.data.workspaces["Layout"]
    yield 2
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    torus(NAME, 96, 48, 0)
    pick(NAME)
    view = area("VIEW_3D").spaces.active
    view.show_region_ui = True
    view.shading.type, view.shading.color_type = "SOLID", "TEXTURE"
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Start")
    count_draws(bpy.types.HOLOMORPH_PT_view3d, "VIEW_3D")
    yield 1
    yield from open_tab("VIEW_3D", seen)


def tiling():
    """By the button, in the background."""
    yield from press_button("VIEW_3D", "tile")
    yield from wait_until(lambda: "holomorph_report" in obj())
    yield 1
    seen["tiled"] = part_report(NAME)["tiling"]["verdict"]
    picture("tiled.png")


def redo_panel():
    """Opened, and changed: the poles stay those that were placed."""
    hud = region(area("VIEW_3D"), "HUD")
    click(hud.x + 30, hud.y + hud.height / 2)
    yield 1.5
    picture("tile_redo_panel.png")
    operator = bpy.context.window_manager.operators[-1]
    seen["last operator"] = operator.bl_idname
    operator.properties.tiles, operator.properties.texture = 150, "BRICKS"
    stages = note_stages()
    with inside(area("VIEW_3D")):
        bpy.ops.ed.undo_redo()
    yield 1
    seen["stages of the redo panel"] = sorted(set(stages))
    seen["texture after the redo panel"] = json.loads(obj()["holomorph_report"])["dials"]
    picture("tile_changed.png")


def steps():
    for part in (prepare, tiling, redo_panel):
        yield from part()


run(steps(), seen)
