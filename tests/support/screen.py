"""Blender's window as a hand and an eye have it: where things are, the pointer, the keys, pictures."""

import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np

SCRIPT = Path(sys.argv[sys.argv.index("--python") + 1])  # whose steps are run
FOLDER = Path(sys.argv[sys.argv.index("--") + 1])  # for pictures
pointer = [0, 0]


def window():
    return bpy.context.window_manager.windows[0]


def enter(workspace):
    """Without the splash screen, and without views that move by themselves."""
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.smooth_view = 0
    window().workspace = bpy.data.workspaces[workspace]
    yield 0.5


def area(kind):
    return next(a for a in window().screen.areas if a.type == kind)


def region(owner, kind):
    return next(r for r in owner.regions if r.type == kind)


def event(kind, value, **keys):
    window().event_simulate(type=kind, value=value, x=pointer[0], y=pointer[1], **keys)


def move(x, y):
    pointer[:] = int(x), int(y)
    event("MOUSEMOVE", "NOTHING")


def click(x, y):
    move(x, y)
    event("LEFTMOUSE", "PRESS")
    event("LEFTMOUSE", "RELEASE")


def tap(kind, **keys):
    event(kind, "PRESS", **keys)
    event(kind, "RELEASE", **keys)


def close_popup():
    """A message or a menu, if one is there: Blender 5 keeps it when the pointer leaves it."""
    tap("ESC")
    yield 0.25


def undo(again=False):
    """By the keys, with the pointer over the 3D view; or what was undone is done again."""
    hover(area("VIEW_3D"))
    yield 0.1
    tap("Z", ctrl=True, shift=again)
    yield 0.5


def hover(owner):
    move(owner.x + owner.width * 0.3, owner.y + owner.height * 0.3)


def inside(owner):
    return bpy.context.temp_override(window=window(), area=owner, region=region(owner, "WINDOW"))


def draw():
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)


def picture(name):
    """The display, which the window fills: pictures that Blender takes itself are black in some versions."""
    draw()
    subprocess.run(["import", "-window", "root", "-quality", "10", str(FOLDER / name)], check=True)  # hardly packed


def pixels(name):
    """(height, width, 3) of a picture that was taken, its lowest row first."""
    image = bpy.data.images.load(str(FOLDER / name))
    values, (width, height) = np.empty(len(image.pixels), np.float32), image.size
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, -1)[..., :3]
