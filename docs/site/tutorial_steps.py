# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender with a window: takes the steps of docs/tutorial.md, and a picture at each (scripts/tutorial).

Leaves FOLDER/NAME.png, the whole window, and in FOLDER/tutorial_steps.json the part of each that is shown.
"""

import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "support"))
from objects import maps, part_report, pick
from running import run, wait_until
from screen import area, enter, hover, inside, picture, region, window
from sidebar import open_sidebar, press_button

ROOT = Path(__file__).resolve().parents[2]
SOLE, END = 0.12, 0.06  # shares of the height and the length: what is beyond them may have poles
BAKED = 1024  # pixels
MUG = 1.15  # distance from which the mug is seen, over that at which it fills the view
seen = {"pictures": {}, "tab": {}}


def show(name, *areas):
    """A picture of these areas of the window."""
    yield 1
    window().cursor_set("DEFAULT")
    picture(f"{name}.png")
    left, low = min(a.x for a in areas), min(a.y for a in areas)
    right, high = max(a.x + a.width for a in areas), max(a.y + a.height for a in areas)
    seen["pictures"][name] = f"{right - left}x{high - low}+{left}+{window().height - high}"
    yield 0.3


def view():
    return area("VIEW_3D")


def load(name):
    """The objects of an example in place of those of the scene; the first one is chosen."""
    for kept in (bpy.data.objects, bpy.data.materials):
        for each in list(kept):
            kept.remove(each)
    with bpy.data.libraries.load(str(ROOT / "blend_examples" / f"{name}.blend")) as (found, wanted):
        wanted.objects = list(found.objects)
    meshes = [o for o in wanted.objects if o.type == "MESH"]
    for obj in meshes:
        bpy.context.scene.collection.objects.link(obj)
    pick(meshes[0].name)
    return meshes[0]


def look(turn=0.6, nod=0.45, distance=1.0):
    """At the selected objects, from the front, turned about the vertical axis and nodded by so many radians."""
    space = view().spaces.active.region_3d
    space.view_perspective = "PERSP"
    space.view_rotation = Euler((np.pi / 2 - nod, 0, turn)).to_quaternion()
    with inside(view()):
        bpy.ops.view3d.view_selected()
    space.view_distance *= distance
    hover(view())


def call(operator, **options):
    with inside(view()):
        operator(**options)
    pick(bpy.context.view_layer.objects.active.name)


def wait_for_maps(obj):
    yield from wait_until(lambda: maps(obj.name))
    yield 1


def prepare():
    yield from enter("Layout")
    space = view().spaces.active
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    space.overlay.show_cursor = False
    load("mug")
    yield from open_sidebar(seen["tab"])


def one_button():
    mug = load("mug")
    look(-0.5, 0.4, MUG)
    yield from show("before", view())
    yield from press_button("VIEW_3D")
    yield from wait_for_maps(mug)
    yield from show("button", view())


def dials():
    """In the panel."""
    window().workspace = bpy.data.workspaces["Layout"]
    yield 2
    mug = load("mug")
    look(-0.5, 0.4, MUG)
    with inside(view()):
        bpy.ops.ed.undo_push(message="Mug")
    yield 1
    yield from press_button("VIEW_3D")
    yield from wait_for_maps(mug)
    for name, value in (("texture", "BRICKS"), ("tiles", 24)):
        setattr(mug.holomorph_map, name, value)
    yield from wait_until(lambda: not mug.holomorph_map.is_waiting)
    yield from show("dials", view())


def add_poles():
    load("critter")
    look(0.1, 0.25, 0.8)
    call(bpy.ops.uv.holomorphic_maps, main="BALANCED", texture="NUMBERED")
    yield from show("coarse", view())
    call(bpy.ops.uv.holomorphic_tile, poles="COARSE", texture="NUMBERED", tiles=48)
    yield from show("poles", view())


def hide_poles():
    """The group is painted on soles, ear tips, snout and tail."""
    critter = load("critter")
    points = np.array([v.co for v in critter.data.vertices])
    share = (points - points.min(axis=0)) / np.ptp(points, axis=0)
    is_hidden = (share[:, 2] < SOLE) | (share[:, 2] > 1 - SOLE) | (np.abs(share[:, 0] - 0.5) > 0.5 - END)
    group = critter.vertex_groups.new(name="Hidden")
    group.add(np.flatnonzero(is_hidden).tolist(), 1.0, "REPLACE")
    look(0.5, -0.1, 0.85)
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    yield from show("group", view())
    bpy.ops.object.mode_set(mode="OBJECT")
    call(bpy.ops.uv.holomorphic_tile, texture="SCALES", tiles=96, pole_group="Hidden")
    seen["poles in the group"] = part_report(critter.name)["tiling"]["poles"]
    seen["sentence with the group"] = part_report(critter.name)["main_map"]["verdict"]["sentence"]
    yield from show("hidden", view())


def levels():
    clay = load("clay")
    clay.rotation_euler = (0, 0, 0)
    call(bpy.ops.uv.holomorphic_tile, texture="NUMBERED", tiles=32)
    call(bpy.ops.object.holomorphic_levels, levels=3, hidden=False)
    view().spaces.active.overlay.show_wireframes = True
    clay.hide_set(True)
    for obj in bpy.context.view_layer.objects:
        obj.select_set(True)
    view().spaces.active.show_region_ui = False
    look(0, 1.2, 0.57)
    for obj in bpy.context.view_layer.objects:
        obj.select_set(False)
    yield from show("levels", view())
    view().spaces.active.overlay.show_wireframes = False
    view().spaces.active.show_region_ui = True


def mark_seams(obj):
    """Between the islands of Smart UV: those that an artist would draw by hand."""
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(angle_limit=1.15)
    bpy.ops.uv.seams_from_islands()
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.uv_layers.remove(obj.data.uv_layers.active)


def see_uvs(image):
    """The whole unit square in the UV editor, over an image that stays."""
    editor = area("IMAGE_EDITOR")
    editor.spaces.active.image, editor.spaces.active.use_image_pin = image, True
    with bpy.context.temp_override(window=window(), area=editor, region=region(editor, "WINDOW")):
        bpy.ops.image.view_all()
        bpy.ops.image.view_zoom_ratio(ratio=0.9 * editor.width / BAKED)


def islands():
    window().workspace = bpy.data.workspaces["UV Editing"]
    yield 2
    view().spaces.active.show_region_ui = False
    mug = load("mug")
    mark_seams(mug)
    look(-0.5, 0.4, MUG)
    call(bpy.ops.uv.holomorphic_maps, main="ISLANDS", texture="NUMBERED")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    empty = bpy.data.images.new("Empty", BAKED, BAKED)
    empty.generated_color = (0.5, 0.5, 0.5, 1)
    see_uvs(empty)
    yield from show("islands", view(), area("IMAGE_EDITOR"))
    bpy.ops.object.mode_set(mode="OBJECT")


def baked():
    """The tiling of bricks, baked to the islands."""
    mug = bpy.context.view_layer.objects.active
    mug.data.uv_layers.active.name = "Bake"
    call(bpy.ops.uv.holomorphic_tile, texture="BRICKS", tiles=24)
    seen["maps"] = maps(mug.name)
    image = bpy.data.images.new("Baked", BAKED, BAKED)
    nodes = mug.active_material.node_tree.nodes
    target = nodes.new("ShaderNodeTexImage")
    target.image = image
    nodes.active = target
    mug.data.uv_layers.active = mug.data.uv_layers["Bake"]
    mug.data.uv_layers["Bake"].active_render = True
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 1, False
    with inside(view()):
        bpy.ops.object.bake(type="DIFFUSE", pass_filter={"COLOR"}, margin=4)
    see_uvs(image)
    yield from show("baked", view(), area("IMAGE_EDITOR"))


PARTS = (one_button, add_poles, hide_poles, levels, islands, baked, dials)


wanted = sys.argv[sys.argv.index("--") + 2 :]
run([prepare, *(part for part in PARTS if not wanted or part.__name__ in wanted)], seen)
