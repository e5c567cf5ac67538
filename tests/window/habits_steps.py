"""Runs inside Blender with a window: the pie menu by its key, selected faces, the sub-panel Tools, a skin.

Leaves FOLDER/habits_steps.json and pictures.
"""

import json

import bmesh
import bpy
from objects import clear, maps, pick, sheet, torus
from running import run, wait_until
from screen import area, click, enter, hover, inside, move, picture, region, tap
from sidebar import open_sidebar

TOOLS = 291  # pixels from the top of the sidebar to the header of Tools, before there is a result
seen = {}


def prepare():
    yield from enter("UV Editing")
    bpy.context.preferences.view.pie_animation_timeout = 0
    bpy.ops.object.mode_set(mode="OBJECT")
    clear()
    torus("Ring", 48, 24, 0)
    sheet("Sheet", 8, -4)
    pick("Ring")
    with inside(area("VIEW_3D")):
        bpy.ops.view3d.view_all()
    area("IMAGE_EDITOR").spaces.active.show_region_ui = True
    yield from open_sidebar(seen)


def pie():
    """Shift U in object mode and in edit mode; its left entry makes the maps."""
    view = area("VIEW_3D")
    for mode in ("OBJECT", "EDIT"):
        pick("Ring")
        bpy.ops.object.mode_set(mode=mode)
        yield 0.12
        centre = view.x + view.width * 0.35, view.y + view.height * 0.5
        move(*centre)
        yield 0.1
        tap("U", shift=True)
        yield 0.25
        picture(f"pie_{mode.lower()}.png")
        yield 0.12
        click(centre[0] - 150, centre[1])
        yield from wait_until(lambda: maps("Ring"))
        yield 0.25
        seen[f"pie in {mode}"] = maps("Ring")
        picture(f"after_pie_{mode.lower()}.png")
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.uv.holomorphic_remove_maps()
        seen[f"removed in {mode}"] = maps("Ring")
        yield 0.1


def selected_faces():
    pick("Ring")
    bpy.ops.object.mode_set(mode="EDIT")
    mesh = bpy.data.objects["Ring"].data
    edited = bmesh.from_edit_mesh(mesh)
    for face in edited.faces:
        face.select_set(face.index < 24 * 24)
    bmesh.update_edit_mesh(mesh)
    hover(area("VIEW_3D"))
    yield 0.1
    tap("U", shift=True, ctrl=True)
    yield from wait_until(lambda: "holomorph_report" in bpy.data.objects["Ring"])
    yield 0.25
    seen["faces"] = json.loads(bpy.data.objects["Ring"]["holomorph_report"])["faces"]
    picture("faces.png")
    bpy.ops.object.mode_set(mode="OBJECT")
    yield 0.25


def tools():
    """The sub-panel, opened by its header."""
    sidebar = region(area("VIEW_3D"), "UI")
    click(sidebar.x + sidebar.width * 0.3, sidebar.y + sidebar.height - TOOLS)
    yield 0.25
    picture("tools.png")
    yield 0.12


def skin():
    sheet_object = bpy.data.objects["Sheet"]
    pick("Sheet")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.delete(type="ONLY_FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    sheet_object.modifiers.new("Skin", "SKIN")
    yield 0.25
    picture("skin.png")
    with inside(area("VIEW_3D")):
        seen["skin"] = list(bpy.ops.uv.holomorphic_maps("INVOKE_DEFAULT", modifiers=True))
    yield 1
    picture("skin_mapped.png")
    seen["objects"] = sorted(bpy.data.objects.keys())


run((prepare, tools, pie, selected_faces, skin), seen)
