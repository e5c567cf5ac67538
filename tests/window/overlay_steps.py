"""Runs inside Blender with a window: looks at what is drawn over the 3D view, and writes down colours of its pixels."""

import addon_utils
import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from enabled import addon, package
from objects import clear, pick, torus
from running import run
from screen import area, enter, inside, picture, pixels, region

seen = {}
TOP = (0.0, 1.0, 0.4)  # a point of the torus in the middle between its vertices
CORNER = (0.02, 0.8)  # in the width and height of the view: nothing is there


def projected(point):
    """Where a point in space is seen, in the region of the view."""
    return location_3d_to_region_2d(region(area("VIEW_3D"), "WINDOW"), area("VIEW_3D").spaces.active.region_3d, point)


def look(name, places, file):
    """Takes a picture, and writes down the colours at places of the view's region."""
    picture(file)
    taken, view = pixels(file), region(area("VIEW_3D"), "WINDOW")
    seen[name] = {key: taken[int(view.y + y), int(view.x + x)].tolist() for key, (x, y) in places.items()}


def look_at_heat(name, file="changed.png"):
    """At the top of the torus, at the ends of the legend, and where nothing is."""
    view, legend = region(area("VIEW_3D"), "WINDOW"), addon("overlays.heat_view")
    unit = bpy.context.preferences.system.ui_scale
    half, high = unit * legend.BAR_WIDTH / 2 - 1, unit * (legend.BAR_ABOVE + legend.BAR_HEIGHT / 2)
    places = {
        "top": projected(TOP),
        "left": (view.width / 2 - half, high),
        "right": (view.width / 2 + half, high),
        "corner": (CORNER[0] * view.width, CORNER[1] * view.height),
    }
    look(name, places, file)


def show(quantity):
    setattr(bpy.context.window_manager, addon("overlays.overlay").HEAT, quantity)


def expected_at_top(quantity):
    """The colour of the face nearest to the top."""
    obj = bpy.data.objects["Torus"]
    polygons, found = addon("results.heat").measured(obj.data, np.eye(3))
    view = addon("overlays.heat_view")
    points, colours = view.lit_triangles(polygons, *view.places_and_scale(found, quantity))
    middles = points.reshape(-1, 3, 3).mean(axis=1)
    return colours[3 * np.argmin(np.linalg.norm(middles - TOP, axis=1)), :3].tolist()


def prepare():
    yield from enter("Layout")
    clear()
    torus("Torus", 49, 25, 0)
    pick("Torus")
    with inside(area("VIEW_3D")):
        bpy.ops.uv.holomorphic_maps(texture="NUMBERED")
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
    shading = area("VIEW_3D").spaces.active.shading
    shading.show_specular_highlight, shading.color_type = False, "SINGLE"  # whatever the texture is
    yield 0.25
    look_at_heat("nothing", "heat_nothing.png")


def heat_maps():
    for quantity in ("DENSITY", "ANGLE"):
        show(quantity)
        yield 0.25
        look_at_heat(quantity.lower(), f"heat_{quantity.lower()}.png")
        seen[quantity.lower()]["expected"] = expected_at_top(quantity)


def changes():
    """What is drawn follows the map, the selection and the switch of all overlays."""
    show("ANGLE")
    layer = bpy.data.objects["Torus"].data.uv_layers.active
    for loop in layer.data:
        loop.uv.x *= 1.7
    bpy.data.objects["Torus"].data.update()
    yield 0.25
    look_at_heat("stretched", "heat_stretched.png")
    seen["stretched"]["expected"] = expected_at_top("ANGLE")
    for name, state in (("without overlays", False), ("with overlays", True)):
        area("VIEW_3D").spaces.active.overlay.show_overlays = state
        yield 0.25
        look_at_heat(name)
    bpy.data.objects["Torus"].select_set(False)
    yield 0.25
    look_at_heat("not selected")
    pick("Torus")
    show("NONE")
    yield 0.25
    look_at_heat("off")


def poles():
    """As if the tiling had a pole at the top of the torus, one behind it, and a branch point beside."""
    obj = bpy.data.objects["Torus"]
    points = addon("scene.mesh_io").world_points(obj)
    corners = {"pole": (0, 1, 0.4), "behind": (0, -1, -0.4), "branch point": (1, 0, 0.4)}
    marked = {name: int(np.argmin(np.linalg.norm(points - place, axis=1))) for name, place in corners.items()}
    report = addon("results.report")
    kinds = {"pole": report.POLE, "behind": report.POLE, "branch point": report.ZERO}
    addon("scene.stored_dials").made(obj).points = " ".join(f"{marked[name]} {kind}" for name, kind in kinds.items())
    places = {name: projected(points[vertex]) for name, vertex in marked.items()}
    unit, (x, y) = bpy.context.preferences.system.ui_scale, addon("overlays.marks_view").LEGEND
    places["legend"] = (region(area("VIEW_3D"), "WINDOW").width / 2 + unit * x, unit * y)
    for name, state in (("with poles", True), ("without poles", False)):
        setattr(bpy.context.window_manager, addon("overlays.overlay").MARKS, state)
        yield 0.25
        look(name, places, f"{name.replace(' ', '_')}.png")


def without_the_addon():
    """Disabled while a heat map is shown: nothing of it is left, and nothing is called any more."""
    show("DENSITY")
    yield 0.25
    addon_utils.disable(package())
    yield 0.25
    look_at_heat("disabled")
    addon_utils.enable(package())
    yield 0.25
    show("DENSITY")
    yield 0.25
    look_at_heat("enabled again")


run((prepare, heat_maps, changes, poles, without_the_addon), seen)
