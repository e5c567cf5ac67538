# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that make maps: the button, islands, seamless tilings. They have the same dials; one stops them."""

import bpy

from .. import native, preferences
from ..scene import stored_dials
from . import dials_view
from .mixins import MODAL_FACES, MODAL_TILED_FACES, OnMeshes, WorkOperator
from .properties import HARD_EDGE, Dials, OfOneRun


class _MapsOperator(Dials, OfOneRun, OnMeshes, WorkOperator):
    """What the operators that make maps share. They start with the dials of the active object, but for those that are
    given; a run writes them back to all that it maps."""

    asked = {}

    def prepare(self, context):
        from ..scene import gathering
        from . import request

        objects = gathering.mesh_objects(context)
        self._start_with_dials_of(objects[0])
        self._own, self._why_not_own = request.own_texture(self)
        found = request.collect(objects, self)
        self._run = request.Run(self, found, self._own, self.is_trial)
        self.is_trial = False  # what the redo panel asks for later is written in any case

    def _start_with_dials_of(self, obj):
        """Takes over dials beside those that the caller has set. What is set now, the redo panel keeps."""
        given = [name for name in Dials.__annotations__ if self.properties.is_property_set(name)]
        for name, value in stored_dials.beside(given, stored_dials.of(obj) | self.asked).items():
            if name in Dials.__annotations__:
                setattr(self, name, value)

    def make_work(self, progress):
        return self._run.job(progress)

    def waiting_faces(self):
        from ..solving import jobs

        waiting = [task for task in self._run.tasks if self._may_tile or jobs.KEPT.get(task.key) is None]
        return sum(task.polygons.face_count for task in waiting)

    def modal_faces(self):
        return MODAL_TILED_FACES if self._may_tile else MODAL_FACES

    @property
    def _may_tile(self):
        return self.main != "BALANCED"

    def written_objects(self):
        return self._run.objects

    def finish(self, step, work, time_has_passed):
        outcome = self._run.write(step, work, time_has_passed)
        outcome.problems += filter(None, [self._why_not_own])
        self.show(step.context, outcome, self.checker, self._own is not None)
        return self.tell(outcome)

    def draw(self, context):
        dials_view.draw(self.layout, self)
        own = preferences.of(context)
        if own is not None and own.research:
            self.layout.prop(self, "use_selection")
            self.layout.prop(self, "residues")


def press(obj):
    """Does what the button does, where this object is active, also without a window: makes the map of its dials."""
    dials = {name: value for name, value in stored_dials.of(obj).items() if name in Dials.__annotations__}
    return bpy.ops.uv.holomorphic_maps("INVOKE_DEFAULT", **dials)


class HOLOMORPH_OT_maps(_MapsOperator, bpy.types.Operator):
    """Lay the texture over the selected objects"""

    bl_idname = "uv.holomorphic_maps"
    bl_label = "Make Map"


class HOLOMORPH_OT_islands(_MapsOperator, bpy.types.Operator):
    """Lay flat pieces side by side, without overlap, cut at hard edges and at your seams"""

    bl_idname = "uv.holomorphic_islands"
    bl_label = "Islands for Baking"
    asked = {"main": "ISLANDS", "hard_edges": HARD_EDGE}


class HOLOMORPH_OT_tile(_MapsOperator, bpy.types.Operator):
    """Lay a texture over the selected objects that breaks nowhere, wherever whole tiles fit"""

    bl_idname = "uv.holomorphic_tile"
    bl_label = "Seamless Tiling"
    asked = {"main": "SEAMLESS"}


class HOLOMORPH_OT_stop(bpy.types.Operator):
    """Stop, and leave everything as it was"""

    bl_idname = "uv.holomorphic_stop"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context):
        return WorkOperator.running is not None

    def execute(self, _context):
        WorkOperator.running.watch.cancel()
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _forget_solves(*_arguments):
    """Drops the solves that were kept for the old file: another file has other meshes."""
    if native.problem():
        return
    from ..solving import jobs

    jobs.KEPT.clear()


_register, _unregister = bpy.utils.register_classes_factory(
    [HOLOMORPH_OT_maps, HOLOMORPH_OT_islands, HOLOMORPH_OT_tile, HOLOMORPH_OT_stop]
)


def register():
    _register()
    bpy.app.handlers.load_pre.append(_forget_solves)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget_solves)
    _unregister()
    _forget_solves()
