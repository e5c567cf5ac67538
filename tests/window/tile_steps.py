"""Runs inside Blender with a window and simulated events: tiles, uses the redo panel and its presets, drags poles."""

import json
import time

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from enabled import addon
from objects import clear, part_report, pick, torus
from running import run, wait_until
from screen import FOLDER, area, click, close_popup, enter, event, inside, move, picture, region, tap, undo
from sidebar import open_sidebar, press_button

seen = {}
NAME = "Ring"
PLANKS = 202  # pixels below the top of the sidebar, of the preset


def obj():
    return bpy.data.objects[NAME]


def is_behind():
    return addon("scene.stored_dials").is_behind(obj())


def uv():
    return addon("scene.uv_maps").read_map(obj().data, "Holomorphic")


def note_stages():
    """A list of the stages that the library's jobs go through from now on."""
    watch, noted = addon("native").load().core.progress.Watch, []
    original = watch.__call__

    def ask(self, fraction, stage):
        noted.append(stage)
        return original(self, fraction, stage)

    watch.__call__ = ask
    return noted


def poles():
    report = addon("results.report")
    vertices, kinds = report.points(obj())
    return vertices[kinds == report.POLE].tolist()


def on_screen(vertex):
    """Where a vertex is seen, in the window."""
    view = region(area("VIEW_3D"), "WINDOW")
    point = addon("scene.mesh_io").world_points(obj(), [vertex])[0]
    place = location_3d_to_region_2d(view, area("VIEW_3D").spaces.active.region_3d, point)
    return view.x + place.x, view.y + place.y


def prepare():
    yield from enter("Layout")
    clear()
    torus(NAME, 96, 48, 0)
    pick(NAME)
    view = area("VIEW_3D").spaces.active
    view.shading.type, view.shading.color_type = "SOLID", "TEXTURE"
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Start")
    yield from open_sidebar(seen)


def tiling():
    """By the button, in the background."""
    with inside(area("VIEW_3D")):
        bpy.ops.uv.holomorphic_tile("INVOKE_DEFAULT", True)
    yield from wait_until(lambda: "holomorph_report" in obj())
    yield 0.25
    seen["tiled"] = part_report(NAME)["main_map"]["verdict"]["sentence"]
    picture("tiled.png")


def redo_panel():
    """Opened; and a preset chosen in the sidebar: the poles stay those that were placed."""
    hud = region(area("VIEW_3D"), "HUD")
    click(hud.x + 30, hud.y + hud.height / 2)
    yield 0.4
    picture("tile_redo_panel.png")
    yield from press_button("VIEW_3D", "presets", 0.78)
    yield 0.25
    picture("tile_presets.png")
    yield 0.12
    stages = note_stages()
    sidebar = region(area("VIEW_3D"), "UI")
    click(sidebar.x + 150, sidebar.y + sidebar.height - PLANKS)
    yield from wait_until(lambda: json.loads(obj()["holomorph_report"])["dials"]["texture"] == "PLANKS")
    yield from close_popup()
    seen["stages of the preset"] = sorted(set(stages))
    seen["texture after the preset"] = json.loads(obj()["holomorph_report"])["dials"]["texture"]
    picture("tile_preset.png")


def visible_pole():
    """Place in the report of a pole on the upper side."""
    points = addon("scene.mesh_io").world_points(obj(), poles())
    return int(np.argmax(points[:, 2]))


def drag_by_hand(pole, place, key):
    """Presses the button, then takes the pole to a vertex and lets it go there. Seconds until the texture follows."""
    yield from press_button("VIEW_3D", "drag", 0.7)
    yield 0.12
    move(*on_screen(poles()[pole]))
    yield 0.12
    picture(f"drag_hovered_{key}.png")
    yield 0.12
    before = uv()
    event("LEFTMOUSE", "PRESS")
    yield 0.1
    move(*on_screen(place))
    start = time.perf_counter()
    yield from wait_until(lambda: not np.array_equal(uv(), before))
    seen["seconds until the texture follows"] = time.perf_counter() - start
    yield 0.25
    picture(f"drag_followed_{key}.png")
    event("LEFTMOUSE", "RELEASE")
    yield 0.1


def dragging():
    with inside(area("VIEW_3D")):  # evened, a torus needs no poles
        bpy.ops.uv.holomorphic_tile("EXEC_DEFAULT", True, poles="COUNT", pole_count=2)
    yield 0.25
    pole, before, old = visible_pole(), uv(), poles()
    points = addon("scene.mesh_io").world_points(obj())
    place = int(np.argmin(np.linalg.norm(points - (0, -1.0, 0.4), axis=1)))
    for key in ("ESC", "RET"):
        yield from drag_by_hand(pole, place, key)
        seen[f"map changed before {key}"] = not np.array_equal(uv(), before)
        tap(key)
        yield 0.25
        seen[f"map as before after {key}"] = bool(np.array_equal(uv(), before))
        seen[f"poles as before after {key}"] = poles() == old
    seen["pole is where it was put"] = poles()[pole] == place
    seen["added distortion after dragging"] = part_report(NAME)["tiling"]["added_distortion"]
    picture("drag_kept.png")
    yield from undo()
    seen["map as before after undo"] = bool(np.array_equal(uv(), before)) and poles() == old
    yield from undo(again=True)
    seen["pole is there after redo"] = poles()[pole] == place
    yield from the_drag_stays(place)


def the_drag_stays(place):
    """With other dials, and in the file."""
    for name, value in (("turns", "NONE"), ("tiles", 30), ("evenness", 0.8)):
        setattr(obj().holomorph_map, name, value)
        yield from wait_until(lambda: not is_behind())
        yield 0.25
    seen["pole is there with other dials"] = place in poles()
    picture("drag_other_dials.png")
    path = str(FOLDER / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    yield 1
    pick(NAME)
    yield from press_button("VIEW_3D")
    yield 1
    yield from wait_until(lambda: addon("operators.mixins").WorkOperator.running is None)
    yield 0.25
    dials = obj().holomorph_map
    seen["dials of the file"] = [dials.turns, dials.tiles, round(dials.evenness, 6)]
    seen["pole is there in the file"] = place in poles()
    picture("drag_loaded.png")


run((prepare, tiling, redo_panel, dragging), seen)
