"""Runs inside Blender with a window and simulated events: the button while an object is sculpted or painted, and in
local view.

Leaves FOLDER/modes_steps.json and pictures.
"""

import bpy
import numpy as np
from objects import clear, maps, pick, torus
from running import run, wait_until
from screen import area, enter, event, inside, move, picture, undo
from sidebar import open_sidebar, press_button

seen = {}


def prepare():
    yield from enter("Layout")
    clear()
    torus("Small", 48, 24, 0)
    torus("Large", 96, 64, 4)  # so large that it is mapped in the background
    yield from open_sidebar(seen)


def wait_for_maps(name):
    yield from wait_until(lambda: maps(name))
    yield 0.25


def begin(name, mode):
    pick(name)
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.object.mode_set(mode=mode)
        bpy.ops.ed.undo_push(message=f"{name} in {mode}")
    yield 0.25


def state(name):
    obj = bpy.data.objects[name]
    return [obj.mode, maps(name)]


def heights(name):
    mesh = bpy.data.objects[name].data
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", values)
    return float(np.abs(values[2::3]).sum())


def painted(name, mode):
    yield from begin(name, mode)
    yield from press_button("VIEW_3D")
    yield from wait_for_maps(name)
    step = f"{name} in {mode}"
    seen[step] = state(name)
    picture(f"{mode.lower()}_{name.lower()}.png")
    yield 0.12
    yield from undo()
    seen[f"{step}, undone"] = state(name)
    yield from undo(again=True)
    seen[f"{step}, done again"] = state(name)
    yield from undo()
    with inside(area("VIEW_3D")):
        bpy.ops.object.mode_set(mode="OBJECT")
    yield 0.12


def stroke():
    """With the brush, through the middle of a side of the ring."""
    view = area("VIEW_3D")
    x, y = view.x + view.width * 0.5, view.y + view.height * 0.5
    low = y - view.height * 0.3
    move(x, low)
    yield 0.1
    event("LEFTMOUSE", "PRESS")
    for step in range(8):
        yield 0.1
        move(x + 4 * step, low + 3 * step)
    event("LEFTMOUSE", "RELEASE")
    yield 0.25


def a_stroke_before_the_button():
    """Undo takes back the map, then the stroke."""
    yield from begin("Small", "SCULPT")
    seen["has a brush"] = bpy.context.scene.tool_settings.sculpt.brush is not None
    flat = heights("Small")
    yield from stroke()
    sculpted = heights("Small")
    yield from press_button("VIEW_3D")
    yield from wait_for_maps("Small")
    seen["after the stroke"] = [*state("Small"), sculpted != flat, heights("Small") == sculpted]
    bpy.context.window_manager.operators[-1].properties.forms = 0
    with inside(area("VIEW_3D")):
        bpy.ops.ed.undo_redo()
    yield 0.25
    seen["the redo panel"] = [*state("Small"), True, heights("Small") == sculpted]
    yield from undo()
    seen["the map undone"] = [*state("Small"), True, heights("Small") == sculpted]
    yield from undo()  # what was before the map, once more
    yield from undo()
    seen["the stroke undone"] = [*state("Small"), True, heights("Small") == flat]
    with inside(area("VIEW_3D")):
        bpy.ops.object.mode_set(mode="OBJECT")


def local_view():
    """Shows one of two selected objects in local view."""
    pick("Small")
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.localview()
        bpy.data.objects["Large"].select_set(True)
        bpy.ops.ed.undo_push(message="Local view")
    yield 0.25
    yield from press_button("VIEW_3D")
    yield from wait_for_maps("Small")
    seen["local view"] = [maps("Small"), maps("Large")]


def both_modes():
    for name, mode in (("Small", "TEXTURE_PAINT"), ("Large", "SCULPT")):
        yield from painted(name, mode)


run((prepare, both_modes, a_stroke_before_the_button, local_view), seen)
