# SPDX-License-Identifier: GPL-3.0-or-later
"""When something is drawn over the 3D view: handlers of Blender's, none in background mode. What: `heat_view`."""

import bpy

from . import heat, native

_handles = []


def _objects(context):
    """The selected meshes that this view shows with overlays, in object mode; the active one first."""
    space = context.space_data
    if context.mode != "OBJECT" or not space.overlay.show_overlays:
        return []
    active = context.view_layer.objects.active
    selected = [o for o in context.view_layer.objects.selected if o.type == "MESH" and o.visible_get(viewport=space)]
    return sorted(selected, key=lambda o: o != active)


def _draw(draw):
    """Calls `draw(heat_view, context, objects, quantity)` where there is something to show."""
    context = bpy.context
    quantity = getattr(context.window_manager, heat.SHOWN)
    objects = [] if quantity == "NONE" or native.problem() else _objects(context)
    if objects:
        from . import heat_view

        draw(heat_view, context, objects, quantity)


def _draw_in_space():
    _draw(lambda view, *arguments: view.draw_faces(*arguments))


def _draw_on_screen():
    _draw(lambda view, *arguments: view.draw_legend(*arguments))


@bpy.app.handlers.persistent
def _forget_after_update(_scene, depsgraph):
    if any(update.is_updated_geometry for update in depsgraph.updates):
        _forget()


@bpy.app.handlers.persistent
def _forget(*_arguments):
    """Batches are made of meshes as they were."""
    if not native.problem():
        from . import heat_view

        heat_view.forget()


HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _forget_after_update),
    (bpy.app.handlers.undo_post, _forget),
    (bpy.app.handlers.redo_post, _forget),
    (bpy.app.handlers.load_pre, _forget),
)


def register():
    if bpy.app.background:
        return
    for function, when in ((_draw_in_space, "POST_VIEW"), (_draw_on_screen, "POST_PIXEL")):
        _handles.append(bpy.types.SpaceView3D.draw_handler_add(function, (), "WINDOW", when))
    for handlers, function in HANDLERS:
        handlers.append(function)


def unregister():
    if bpy.app.background:
        return
    for handlers, function in HANDLERS:
        handlers.remove(function)
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    _forget()
