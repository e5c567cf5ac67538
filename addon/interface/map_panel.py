# SPDX-License-Identifier: GPL-3.0-or-later
"""The box *Map*: the button, the dials of the active object, its points, the verdict; and *Advanced*."""

import bpy

from .. import native, preferences
from ..operators import drag, follow
from ..operators.dials import HOLOMORPH_OT_quarter
from ..operators.dials_view import dial, draw_texture, row
from ..operators.mapping import HOLOMORPH_OT_islands, HOLOMORPH_OT_maps, HOLOMORPH_OT_stop, HOLOMORPH_OT_tile
from ..operators.mixins import CONVERT, CONVERTIBLE, WorkOperator
from ..operators.properties import UNLINED
from ..operators.symmetric import HOLOMORPH_OT_make_symmetric
from ..overlays import overlay
from ..scene import stored_dials
from . import lines, verdict_view, words

UNTILED = {"BALANCED", "ISLANDS"}  # values of the dial of seams without tiles that fit together
SECONDS_EACH = 7e-5  # for each triangle: some 6 s at 100,000, by `scripts/benchmark click`
LONG = 5  # seconds from which on they are told before
NARROW = 240  # pixels of a sidebar in which other words need the room of a fraction
MAKING = "Making Map (ESC stops)"
TURNED = {2: "½", 4: "¼", 6: "⅙"}


class HOLOMORPH_MT_make(bpy.types.Menu):
    bl_label = "Make Map as"

    def draw(self, context):
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(HOLOMORPH_OT_maps.bl_idname, text="Automatic", icon="UV").main = "AUTOMATIC"
        layout.operator(HOLOMORPH_OT_tile.bl_idname, icon="TEXTURE")
        layout.operator(HOLOMORPH_OT_islands.bl_idname, icon="UV_ISLANDSEL")
        if context.mode == "EDIT_MESH":
            layout.separator()
            chosen = layout.operator(HOLOMORPH_OT_maps.bl_idname, text="Selected Faces Only", icon="FACESEL")
            chosen.use_selection = "FACES"
            chosen = layout.operator(HOLOMORPH_OT_tile.bl_idname, text="Points at Selected Vertices", icon="VERTEXSEL")
            chosen.poles = "SELECTED"
            chosen = layout.operator(HOLOMORPH_OT_maps.bl_idname, text="Corners of a Rectangle", icon="MESH_PLANE")
            chosen.use_selection, chosen.main = "RECTANGLE", "AUTOMATIC"


class MapPanel:
    bl_label = "Map"

    def draw(self, context):
        layout, obj = self.layout, context.active_object
        made = None if native.problem() else stored_dials.made(obj)
        is_edited = made is not None and _is_edited(obj)
        is_old = is_edited or (made is not None and stored_dials.is_behind(obj))
        button = layout.row(align=True)
        button.scale_y = 1.5
        _draw_button(button, is_old)
        layout = layout.column()
        layout.enabled = not is_blocked()
        if native.problem():
            lines.draw(layout.column(align=True), context, native.problem(), "ERROR")
        elif obj is not None and obj.type in CONVERTIBLE:
            lines.draw(layout.column(align=True), context, CONVERT, "INFO")
        elif obj is not None and obj.type == "MESH":
            dials = getattr(obj, stored_dials.NAME)
            _draw_dials(layout.column(), context, dials, made)
            _draw_note(layout.column(align=True), context, obj, dials, is_old or made is None)
            if made:
                verdict_view.draw(layout, context, made, is_edited)


def is_blocked():
    """Whether work is going on during which nothing may be changed."""
    return WorkOperator.running is not None and follow.HOLOMORPH_OT_follow.active is None


def _is_edited(obj):
    from ..results import report

    return report.is_edited(obj)


def _draw_button(layout, is_update):
    running = WorkOperator.running
    if running is None:
        text = "Update Map" if is_update else HOLOMORPH_OT_maps.bl_label
        layout.operator(HOLOMORPH_OT_maps.bl_idname, text=text, icon="UV")
        layout.menu(HOLOMORPH_MT_make.__name__, text="", icon="DOWNARROW_HLT")
    elif bpy.app.version >= (4, 0):
        layout.progress(text=words.said(MAKING), factor=running.watch.fraction)
        layout.operator(HOLOMORPH_OT_stop.bl_idname, text="", icon="X")
    else:
        layout.label(text=f"{words.said(MAKING)}: {running.watch.fraction:.0%}")


def _draw_dials(layout, context, dials, made):
    draw_texture(layout, dials)
    is_tiled = dials.main not in UNTILED
    name = "size" if dials.by_size or not is_tiled else "tiles"
    _draw_count(layout, dials, name)
    dial(layout, dials, "evenness", slider=True)
    if not is_tiled:
        return
    line = dial(layout, dials, "turns")
    if made and made.turns in TURNED and context.region.width > NARROW * context.preferences.system.ui_scale:
        end = line.row(align=True)
        end.ui_units_x = 1
        end.label(text=TURNED[made.turns])
    if made and made.shown_turns:
        line.operator(HOLOMORPH_OT_make_symmetric.bl_idname, text="", icon="MOD_MIRROR")
    line = dial(layout, dials, "direction")
    line.operator(HOLOMORPH_OT_quarter.bl_idname, text="", icon="DRIVER_ROTATIONAL_DIFFERENCE")
    if made and made.point_count:
        line = row(layout, words.said(f"{made.point_count} Points"))
        if made.movable_count:
            line.operator(drag.HOLOMORPH_OT_drag_poles.bl_idname, text="Drag", icon="VIEW_PAN")
        if dials.moved:
            line.operator(drag.HOLOMORPH_OT_automatic_points.bl_idname, text="", icon="LOOP_BACK")
        is_shown = getattr(context.window_manager, overlay.MARKS)
        text = "" if made.movable_count else "Shown"
        line.prop(context.window_manager, overlay.MARKS, text=text, icon="HIDE_OFF" if is_shown else "HIDE_ON")


def _draw_count(layout, dials, name):
    """The row of the tiles or of their size: a number, or where there is none yet, a button that gives one."""
    switch = {"tiles": "by_count", "size": "by_size"}[name]
    if getattr(dials, switch):
        made = dial(layout, dials, name, f"{name}_shown")
    else:
        made = dial(layout, dials, name, switch, text="Automatic", toggle=True)
    if dials.main not in UNTILED:
        made.prop(dials, "by_size", text="", icon="DRIVER_DISTANCE")


def _draw_note(layout, context, obj, dials, is_to_make):
    seconds = _expected_seconds(context) if is_to_make else 0
    if dials.refused:
        lines.draw(layout, context, dials.refused, "ERROR")
    elif obj.modifiers and not len(obj.data.polygons) and not dials.modifiers:
        lines.draw(layout, context, "Its faces come only from modifiers: switch With Modifiers on", "INFO")
    elif seconds >= LONG and WorkOperator.running is None:
        lines.draw(layout, context, f"Takes about {in_words(seconds)}", "TIME")


def _expected_seconds(context):
    """What the button takes for the selected meshes, on a computer of today."""
    meshes = {one.data for one in context.selected_objects if one.type == "MESH"}
    return SECONDS_EACH * sum(len(mesh.loops) - 2 * len(mesh.polygons) for mesh in meshes)


def in_words(seconds):
    unit, name = (60, "min") if seconds >= 60 else (1, "s")
    return f"{float(f'{seconds / unit:.1g}'):.0f} {name}"


class AdvancedPanel:
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return not native.problem() and context.active_object is not None and context.active_object.type == "MESH"

    def draw(self, context):
        obj = context.active_object
        dials, column = getattr(obj, stored_dials.NAME), self.layout.column()
        dial(column, dials, "main")
        dial(column, dials, "rotation")
        for name in shown(dials):
            dial(column, dials, name)
        if dials.main not in UNTILED:
            row(column, "Only in").prop_search(dials, "pole_group", obj, "vertex_groups", text="")
        for name in _switches(context, obj, dials):
            row(column, "").prop(dials, name)


class ResearchPanel:
    bl_label = "Research"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        own = preferences.of(context)
        return AdvancedPanel.poll(context) and own is not None and own.research

    def draw(self, context):
        obj = context.active_object
        dials, column = getattr(obj, stored_dials.NAME), self.layout.column()
        for name in ("forms", "shown", "density", "checker_scale", "solver"):
            dial(column, dials, name)
        for name in ("cut_at_seams", "shape"):
            row(column, "").prop(dials, name)


def shown(dials):
    """The dials that do something on this object."""
    if dials.main == "ISLANDS":
        return "hard_edges", "most_stretch", "margin"
    if dials.main == "BALANCED":
        return ("margin",)
    names = [] if dials.turns in UNLINED else ["rows"]
    names += ["lattice", "boundary", "repeats", "poles"]
    return [*names, "pole_count"] if dials.poles == "COUNT" else names


def _switches(context, obj, dials):
    yield "seams"
    if len([one for one in context.selected_objects if one.type == "MESH"]) > 1:
        yield "equal"
    if obj.modifiers:
        yield "modifiers"
    if dials.main == "SEAMLESS":
        yield "empties"


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_MT_make])
