# SPDX-License-Identifier: GPL-3.0-or-later
"""When something is drawn over the 3D view: switches, and handlers of Blender's, none in background mode.

What is drawn is in `heat_view` and `marks_view`, which are imported when they are first needed.
"""

from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty

from .. import native

HEAT, MARKS = "holomorphic_heat", "holomorphic_marks"  # properties of the window manager
QUANTITIES = (
    ("NONE", "Off", "Show no heat map"),
    ("DENSITY", "Density", "Show where the texture is denser or coarser than the median, by UV area"),
    ("ANGLE", "Angle Distortion", "Show where squares become rhombi or rectangles: s1 / s2, 1 where they stay squares"),
    ("DIRECTION", "Direction", "Show where the texture leans, lies on its side or stands on its head: degrees from up"),
)

_handles = []


@dataclass(frozen=True)
class Dragged:
    """The marks of an object whose poles are dragged, or its cones."""

    poles: object  # vertices; or the cones
    zeros: object  # vertices
    hovered: int | None  # among the poles
    are_cones: bool = False


dragged = {}  # `Dragged` by the object's name, while it lasts


def _objects(context):
    """The selected meshes that this view shows with overlays, in object mode; the active one first."""
    from .. import compatibility

    space = context.space_data
    if native.problem() or context.mode != "OBJECT" or not space.overlay.show_overlays:
        return []
    active = context.view_layer.objects.active
    selected = compatibility.selected_in(context.view_layer)
    shown = [o for o in selected if o.type == "MESH" and o.visible_get(viewport=space)]
    return sorted(shown, key=lambda o: o != active)


def _draw_in_space():
    _draw(lambda view, *what: view.draw(*what))


def _draw_on_screen():
    _draw(lambda view, *what: view.draw_legend(*what))


def _draw(draw):
    context = bpy.context
    objects, quantity = _objects(context), getattr(context.window_manager, HEAT)
    if objects and quantity != "NONE":
        from . import heat_view

        draw(heat_view, context, objects, quantity)
    if objects and (dragged or getattr(context.window_manager, MARKS)):
        from . import marks_view

        draw(marks_view, context, objects, dragged)


@bpy.app.handlers.persistent
def _forget_after_update(_scene, depsgraph):
    if any(update.is_updated_geometry for update in depsgraph.updates):
        _forget()


@bpy.app.handlers.persistent
def _forget(*_arguments):
    """Drops the batches, which are of meshes as they were."""
    if not native.problem():
        from . import heat_view

        heat_view.forget()


def _redraw(manager, _context):
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _forget_after_update),
    (bpy.app.handlers.undo_post, _forget),
    (bpy.app.handlers.redo_post, _forget),
    (bpy.app.handlers.load_pre, _forget),
)


def _register_switches():
    manager = bpy.types.WindowManager
    text = "Heat map of the active UV maps of the selected meshes"
    setattr(manager, HEAT, EnumProperty(name="Heat Map", description=text, items=QUANTITIES, update=_redraw))
    text = "Show a dot wherever more or fewer tiles meet than elsewhere"
    setattr(manager, MARKS, BoolProperty(name="Show Points", description=text, default=True, update=_redraw))


def register():
    _register_switches()
    if bpy.app.background:
        return
    for function, when in ((_draw_in_space, "POST_VIEW"), (_draw_on_screen, "POST_PIXEL")):
        _handles.append(bpy.types.SpaceView3D.draw_handler_add(function, (), "WINDOW", when))
    for handlers, function in HANDLERS:
        handlers.append(function)


def unregister():
    if not bpy.app.background:
        for handlers, function in HANDLERS:
            handlers.remove(function)
        while _handles:
            bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
        _forget()
    for name in (MARKS, HEAT):
        delattr(bpy.types.WindowManager, name)
