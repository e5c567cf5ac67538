"""Runs inside Blender with a window and simulated events: drags dials of the sidebar, and undoes what they did."""

import bpy
import numpy as np
from enabled import addon
from objects import clear, pick, torus
from running import run, wait_until
from screen import area, enter, event, inside, move, picture, region, tap, undo
from sidebar import open_sidebar, press_button

seen = {}
EVENNESS = 128  # pixels below the top of the sidebar
STEPS = 8  # of the pointer


def obj():
    return bpy.data.objects["Ring"]


def uv():
    return addon("scene.uv_maps").read_map(obj().data, "Holomorphic").copy()


def is_behind():
    return addon("scene.stored_dials").is_behind(obj())


def state():
    return obj().holomorph_map.evenness, uv()


def is_same(first, second):
    return first[0] == second[0] and bool(np.array_equal(first[1], second[1]))


def prepare():
    yield from enter("Layout")
    clear()
    torus("Ring", 24, 12, 0)
    pick("Ring")
    with inside(area("VIEW_3D")):
        bpy.ops.ed.undo_push(message="Start")
    yield from open_sidebar(seen)
    yield from press_button("VIEW_3D")
    yield from wait_until(lambda: "holomorph_report" in obj())
    yield 0.5


def drag_slider(name):
    """Drags the slider of the evenness to the right; takes down the map in the middle and after."""
    sidebar = region(area("VIEW_3D"), "UI")
    x, y = sidebar.x + 0.55 * sidebar.width, sidebar.y + sidebar.height - EVENNESS
    before = state()
    move(x, y)
    yield 0.3
    event("LEFTMOUSE", "PRESS")
    yield 0.1
    for step in range(1, STEPS + 1):
        move(x + 4 * step, y)
        yield 0.08
    seen[f"{name}: followed before the release"] = not np.array_equal(uv(), before[1])
    event("LEFTMOUSE", "RELEASE")
    yield from wait_until(lambda: obj().holomorph_map.evenness != before[0] and not is_behind())
    yield 0.5
    picture(f"dials_{name}.png")
    after = state()
    seen[f"{name}: dial and map changed"] = after[0] != before[0] and not np.array_equal(after[1], before[1])
    yield from undo()
    seen[f"{name}: undo"] = not is_behind()
    if not is_same(state(), before):  # the step of the slider comes before that of the map
        yield from undo()
    seen[f"{name}: undone"] = is_same(state(), before)
    for _ in range(2):
        if not is_same(state(), after):
            yield from undo(again=True)
            seen[f"{name}: redo"] = not is_behind()
    seen[f"{name}: done again"] = is_same(state(), after)


def live():
    yield from drag_slider("live")


def slow():
    follow = addon("operators.follow")
    follow.LIVE_SECONDS = -1.0
    yield from drag_slider("slow")


def escape():
    before = state()
    follow = addon("operators.follow")
    follow.REST_SECONDS = 60.0
    obj().holomorph_map.evenness = 0.1
    yield 0.5
    seen["escape: waits"] = is_behind()
    move(area("VIEW_3D").x + 300, area("VIEW_3D").y + 300)
    tap("ESC")
    yield 0.3
    seen["escape: as before"] = is_same(state(), before)


def fault():
    """An error that nobody expects, and then another map."""
    follow = addon("operators.follow")
    before, making = state(), follow._Making
    follow.LIVE_SECONDS, follow.REST_SECONDS = -1.0, 0.1

    def fail(_obj):
        follow._Making = making
        raise MemoryError("planted")

    follow._Making = fail
    obj().holomorph_map.evenness = 0.2
    yield from wait_until(lambda: follow._Making is making)
    yield 0.3
    seen["fault: map stays"] = bool(np.array_equal(uv(), before[1])) and is_behind()
    obj().holomorph_map.evenness = 0.3
    yield from wait_until(lambda: not is_behind())
    seen["fault: the next map follows"] = not np.array_equal(uv(), before[1])


run((prepare, live, slow, escape, fault), seen)
