# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator with which the poles of a tiling are dragged over the surface, while the texture follows."""

import re
from contextlib import contextmanager

import bpy
from bpy.props import StringProperty

from ..overlays import overlay
from ..scene import stored_dials
from .mixins import TIMER_SECONDS, Explained, OnMeshes

NAVIGATION = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION"}
NAVIGATION |= {f"NUMPAD_{key}" for key in (*range(10), "PERIOD", "PLUS", "MINUS")}
KEEP = {"RET", "NUMPAD_ENTER", "SPACE"}
GIVE_UP = {"ESC", "RIGHTMOUSE"}
HELP = "Drag a dot   (Enter: keep, ESC: undo all)"


class HOLOMORPH_OT_drag_poles(Explained, bpy.types.Operator):
    """Pull a dot to where it shows less, and the map follows"""

    bl_idname = "uv.holomorphic_drag_poles"
    bl_label = "Drag Points"

    left_modes = frozenset()  # the poles are shown in object mode alone
    moves: StringProperty(
        name="Moves",
        description='Points to move, as pairs of a number in the report and a vertex: "0:512 3:77"',
        default="",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def why_not(cls, context):
        made = stored_dials.made(context.active_object)
        if made is None or not made.point_count:
            return "Select an object whose map has points"
        if made.movable_count:
            return ""
        return "The points of a map that is cut stay where they are: set Seams in Advanced to None for others"

    def execute(self, context):
        """Moves the poles at once: for scripts, and the redo panel."""
        from .drag_session import Session

        try:
            moves, session = parsed_moves(self.moves), Session(context.active_object)
            session.mapped = session.made(moves)
        except ValueError as error:
            return self.refuse(error)
        return self.tell(session.finish(context))

    def invoke(self, context, _event):
        if context.area is None or context.area.type != "VIEW_3D":
            return self.refuse("Drag points in a 3D view")
        from . import surface_pick
        from .drag_session import Session

        try:
            self._session = Session(context.active_object)
        except ValueError as error:
            return self.refuse(error)
        self._object = context.active_object
        self._view, self._surface = surface_pick.View(context.area), surface_pick.Surface(self._object)
        self._moves, self._wanted, self._job = {}, {}, None
        self._hovered, self._dragged, self._timer = None, False, None
        with self._giving_up(context):
            self._timer = context.window_manager.event_timer_add(TIMER_SECONDS, window=context.window)
            context.workspace.status_text_set(HELP)
            self._show_marks(context)
            context.window_manager.modal_handler_add(self)
            return {"RUNNING_MODAL"}

    def modal(self, context, event):
        with self._giving_up(context):
            return self._handle(context, event)

    @contextmanager
    def _giving_up(self, context):
        """Puts everything back if an error is raised within."""
        try:
            yield
        except BaseException:
            self.cancel(context)
            raise

    def _handle(self, context, event):
        if event.type in GIVE_UP and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type in KEEP and event.value == "PRESS":
            return self._keep(context)
        if event.type in NAVIGATION and not self._dragged:
            return {"PASS_THROUGH"}
        self._hear(context, event)
        is_outside = not self._view.contains(event.mouse_x, event.mouse_y)
        return {"PASS_THROUGH"} if event.type == "MOUSEMOVE" and is_outside else {"RUNNING_MODAL"}

    def _hear(self, context, event):
        if event.type == "TIMER":
            self._follow(context)
        elif event.type == "MOUSEMOVE":
            self._point(context, event)
        elif event.type == "LEFTMOUSE":
            self._dragged = event.value == "PRESS" and self._hovered is not None

    def cancel(self, context):
        """Puts everything back; also called when another file is loaded, or the program ends."""
        self._end(context)
        self._session.restore()

    def _point(self, context, event):
        """Highlights the nearest pole, or takes the dragged one to the pointer's vertex."""
        from ..scene import mesh_io
        from . import surface_pick

        x, y = event.mouse_x, event.mouse_y
        if self._dragged:
            near = self._surface.vertices_at(*self._view.ray(x, y))
            places = [vertex for vertex in near if self._session.may_go_to(self._hovered, vertex)]
            if places:
                self._wanted = {**self._wanted, self._hovered: places[0]}
        else:
            points = mesh_io.world_points(self._object, self._session.poles)
            reach = surface_pick.REACH * context.preferences.system.ui_scale
            self._hovered = surface_pick.nearest(self._view, points, x, y, reach)
        self._show_marks(context)

    def _follow(self, context):
        """Takes over what the worker has made, and sets it to work again where the pointer went on."""
        if self._job is not None:
            if self._job.is_running():
                return
            self._take(context)
        if self._wanted != self._moves:
            self._moves = self._wanted
            self._job = self._session.job(self._moves)
            self._job.start()

    def _take(self, context):
        job, self._job = self._job, None
        job.wait()
        try:
            self._session.show(self._session.taken(job))
        except ValueError as error:
            context.workspace.status_text_set(f"{error}   (Enter: keep, ESC: undo all)")
            return
        context.workspace.status_text_set(f"{self._said()}   |   {HELP}")
        self._show_marks(context)

    def _said(self):
        done = [part.tiling for part in self._session.mapped.tiled]
        added = max(made.added_distortion for made in done)
        size = max(made.size_range for made in done)
        if self._session.are_cones:
            return f"size range {size:.3g}, angle distortion {max(made.quality.mean_angle for made in done):.3g}"
        return f"angle distortion added by whole tiles: {added:.4f}, size range {size:.3g}"

    def _keep(self, context):
        """Waits for the moves that were asked for last, and keeps them."""
        self._follow(context)
        if self._job is not None:
            self._job.wait()
            self._take(context)
        self._end(context)
        moved = self._session.poles
        self.moves = " ".join(f"{pole}:{moved[pole]}" for pole in self._moves)
        if not self._moves:
            return {"CANCELLED"}
        return self.tell(self._session.finish(context))

    def _end(self, context):
        if self._job is not None:
            self._job.cancel()
            self._job.wait()
            self._job = None
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        context.workspace.status_text_set(None)
        overlay.dragged.clear()
        context.area.tag_redraw()

    def _show_marks(self, context):
        session, poles = self._session, self._session.poles
        for pole, vertex in self._wanted.items():
            poles[pole] = vertex
        overlay.dragged[self._object.name] = overlay.Dragged(poles, session.zeros, self._hovered, session.are_cones)
        context.area.tag_redraw()


class HOLOMORPH_OT_automatic_points(OnMeshes, bpy.types.Operator):
    """Put all points back where they show least"""

    bl_idname = "uv.holomorphic_automatic_points"
    bl_label = "Automatic Points"

    def execute(self, context):
        setattr(getattr(context.active_object, stored_dials.NAME), stored_dials.MOVED, "")
        return {"FINISHED"}


def parsed_moves(text):
    """{pole: vertex} of "0:512 3:77". @throws ValueError"""
    if not re.fullmatch(r"\s*(\d+:\d+(\s+|$))*", text):
        raise ValueError(f'moves are {text!r}; pairs such as "0:512" are needed')
    return {int(pole): int(vertex) for pole, vertex in (pair.split(":") for pair in text.split())}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_drag_poles, HOLOMORPH_OT_automatic_points])
