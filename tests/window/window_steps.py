"""Runs inside Blender with a window and simulated events: uses the add-on as an artist does, writes down what happened.

Leaves FOLDER/window_steps.json (name of the step: what was seen) and pictures.
"""

import threading
import time

import bpy
from enabled import addon
from objects import clear, maps, part_report, pick, pick_vertices, sheet, torus
from running import run, wait_until
from screen import area, click, enter, hover, inside, picture, region, tap, undo
from sidebar import count_draws, drawn, open_tab, press_button

CROSS = 0.86  # of the sidebar's width
HAS_CROSS = bpy.app.version >= (4, 2)
seen = {}


def note(method):
    """A list that gets the time at which the operator first calls this method of its modal part."""
    called = []
    operator = addon("operators.mapping").HOLOMORPH_OT_maps
    original = getattr(operator, method)

    def noted(self, context):
        called.append(time.perf_counter())
        setattr(operator, method, original)
        original(self, context)

    setattr(operator, method, noted)
    return called


def hold_back_the_worker():
    """At the library's next question: however long the window takes to draw, ESC comes before the work is done. Returns
    what lets it go on."""
    watch = addon("native").load().core.progress.Watch
    original, gate = watch.__call__, threading.Event()

    def ask(self, fraction, stage):
        gate.wait()
        return original(self, fraction, stage)

    def let_go():
        watch.__call__ = original
        gate.set()

    watch.__call__ = ask
    return let_go


def prepare():
    yield from enter("UV Editing")
    bpy.ops.object.mode_set(mode="OBJECT")
    clear()
    torus("Small", 48, 24, 0)
    torus("Big", 240, 200, 3)
    sheet("Sheet", 8, -4)
    pick("Small")
    with inside(area("VIEW_3D")):
        area("VIEW_3D").spaces.active.shading.type = "SOLID"
        area("VIEW_3D").spaces.active.shading.color_type = "TEXTURE"
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Start")
    for kind in drawn:
        area(kind).spaces.active.show_region_ui = True
    count_draws(bpy.types.HOLOMORPH_PT_view3d, "VIEW_3D")
    count_draws(bpy.types.HOLOMORPH_PT_image, "IMAGE_EDITOR")
    yield 0.5


def small_mesh():
    yield from open_tab("VIEW_3D", seen)
    picture("panel.png")
    yield 0.12
    yield from press_button("VIEW_3D")
    yield 0.5
    seen["button"] = maps("Small")
    picture("button.png")
    yield from undo()
    seen["undo"] = maps("Small")
    yield from undo(again=True)
    seen["redo"] = maps("Small")


def redo_panel():
    """A change in the redo panel undoes, sets the property and executes again: what this operator does."""
    yield from press_button("VIEW_3D")
    yield 0.25
    hud = region(area("VIEW_3D"), "HUD")
    seen["hud"] = [hud.x, hud.y, hud.width, hud.height]
    click(hud.x + 30, hud.y + hud.height / 2)
    yield 0.25
    picture("redo_panel.png")
    operator = bpy.context.window_manager.operators[-1]
    seen["last operator"] = operator.bl_idname
    operator.properties.density = 2.0
    start = time.perf_counter()
    with inside(area("VIEW_3D")):
        bpy.ops.ed.undo_redo()
    seen["redo panel"] = {"maps": maps("Small"), "seconds": time.perf_counter() - start}
    yield 0.25


def image_editor():
    pick("Small")
    while maps("Small"):
        layers = bpy.data.objects["Small"].data.uv_layers
        layers.remove(layers[0])
    yield from open_tab("IMAGE_EDITOR", seen)
    yield from press_button("IMAGE_EDITOR")
    yield 0.5
    seen["button of the UV editor"] = maps("Small")


def edit_mode():
    view = area("VIEW_3D")
    with inside(view):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        while bpy.data.objects["Small"].data.uv_layers:
            bpy.ops.mesh.uv_texture_remove()
        bpy.ops.ed.undo_push(message="In edit mode")
    yield 0.25
    yield from press_button("VIEW_3D")
    yield 0.5
    seen["button in edit mode"] = maps("Small")
    picture("edit_mode.png")
    yield from undo()
    seen["undo in edit mode"] = maps("Small")
    seen["mode after undo"] = bpy.data.objects["Small"].mode
    with inside(view):
        bpy.ops.object.mode_set(mode="OBJECT")


def chosen_vertices():
    view = area("VIEW_3D")
    pick("Sheet")
    with inside(view):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.view3d.view_selected()
    for use, vertices in (("RECTANGLE", (0, 8, 72, 80)), ("POLES", (40,))):
        pick_vertices("Sheet", vertices)
        hover(view)
        yield 0.25
        with inside(view):
            bpy.ops.uv.holomorphic_maps("INVOKE_DEFAULT", True, use_selection=use)
        yield 0.5
        seen[f"part after {use.lower()}"] = part_report("Sheet")
        picture(f"{use.lower()}.png")
        yield 0.12
    with inside(view):
        bpy.ops.object.mode_set(mode="OBJECT")


def stopped(way):
    """While it runs, by the key or by the cross beside the progress; seconds until it ends."""
    ended, shown = note("_end_modal"), note("_show_progress")
    let_go = hold_back_the_worker()
    yield from press_button("VIEW_3D")
    yield from wait_until(lambda: shown)
    yield 0.1  # for it to be drawn
    seen[f"no maps before the {way}"] = maps("Big")
    picture(f"running_{way.lower()}.png")
    start = time.perf_counter()
    if way == "cross":
        yield from press_button("VIEW_3D", right=CROSS)
    else:
        tap(way)
    yield from wait_until(lambda: ended)
    seen[f"seconds until the {way} ends it"] = ended[0] - start
    yield 0.12
    let_go()
    yield 0.12
    seen[f"after the {way}"] = maps("Big")


def big_mesh():
    view = area("VIEW_3D")
    pick("Big")
    with inside(view):
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Big")
    yield 0.25
    yield from stopped("ESC")
    if HAS_CROSS:
        yield from stopped("cross")
    yield from press_button("VIEW_3D")
    yield from wait_until(lambda: maps("Big"))
    yield 0.25
    seen["modal run"] = maps("Big")
    picture("modal.png")
    yield from undo()
    seen["undo of the modal run"] = maps("Big")
    yield from undo(again=True)
    seen["redo of the modal run"] = maps("Big")


def level_names():
    return sorted(o.name for o in bpy.data.objects if "_LOD" in o.name)


def levels_of_detail():
    """Makes levels of the big mesh with the worker thread: once cancelled, once to the end, undone in one step."""
    view = area("VIEW_3D")
    pick("Big")
    with inside(view):
        bpy.ops.ed.undo_push(message="Before the levels")
        seen["levels begin"] = list(bpy.ops.object.holomorphic_levels("INVOKE_DEFAULT", levels=2))
    hover(view)
    tap("ESC")
    yield 0.5
    seen["levels after ESC"] = level_names()
    with inside(view):
        bpy.ops.object.holomorphic_levels("INVOKE_DEFAULT", levels=2, hidden=False)
    yield from wait_until(level_names)
    yield 0.25
    seen["levels"] = level_names()
    seen["maps of a level"] = maps("Big_LOD2")
    picture("levels.png")
    yield from undo()
    seen["undo of the levels"] = level_names()


run((prepare, small_mesh, redo_panel, image_editor, edit_mode, chosen_vertices, big_mesh, levels_of_detail), seen)
