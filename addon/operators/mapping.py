# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that make maps: the button, islands, seamless tilings."""

import bpy
from bpy.props import FloatProperty

from .. import native
from .mixins import MODAL_FACES, MODAL_TILED_FACES, OnMeshes, WorkOperator
from .properties import ABOUT, HARD_EDGE, OWN_TEXTURES, MapProperties, hard_edges_property, main_property
from .tile_properties import TileProperties


class _MapsOperator(OnMeshes, WorkOperator):
    """What the operators that make maps share."""

    def prepare(self, context):
        from ..scene import gathering, targets
        from . import request

        objects, choices = gathering.mesh_objects(context), request.choices(self)
        self._own = self._own_texture()
        self._run = request.Run(self, targets.collect(objects, choices), self._own, self.is_trial)
        self.is_trial = False  # what the redo panel asks for later is written in any case

    def _own_texture(self):
        """The `user_texture.Own` that was chosen. If there is none, the redo panel says why; it must not vanish, so
        that the checker is shown.
        """
        self.found = ""
        if self.texture not in OWN_TEXTURES:
            return None
        from ..materials import user_texture

        try:
            chosen = user_texture.chosen(self)
        except ValueError as error:
            self.found = native.sentence(error)
            return None
        self.found = chosen.text
        return chosen

    def make_work(self, progress):
        return self._run.job(progress)

    def waiting_faces(self):
        from ..solving import jobs

        waiting = [task for task in self._run.tasks if self.may_tile() or jobs.KEPT.get(task.key) is None]
        return sum(task.polygons.face_count for task in waiting)

    def modal_faces(self):
        return MODAL_TILED_FACES if self.may_tile() else MODAL_FACES

    def written_objects(self):
        return self._run.objects

    def finish(self, step, work, time_has_passed):
        outcome = self._run.write(step, work, time_has_passed)
        self.form_count, self.tile_count = outcome.forms, outcome.tiles
        if self._own is None and self.found:
            outcome.problems.append(self.found)
        self.show(step.context, outcome, self.checker, self._own is not None)
        return self.tell(outcome)


class HOLOMORPH_OT_maps(MapProperties, _MapsOperator, bpy.types.Operator):
    """Compute conformal UV maps for the selected meshes, whatever their shape; in edit mode for the selected faces.
    Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_maps"
    bl_label = "Holomorphic UV Maps"
    bl_options = {"REGISTER", "UNDO", "PRESET"}


class HOLOMORPH_OT_islands(MapProperties, _MapsOperator, bpy.types.Operator):
    """Cut the selected meshes along their hard edges and seams, and flatten each island: for meshes of few or long thin
    faces, which no seamless map can fit"""

    bl_idname = "uv.holomorphic_islands"
    bl_label = "Islands by Hard Edges"

    # Properties of its own, so that the maps operator does not remember them.
    main: main_property("ISLANDS")
    hard_edges: hard_edges_property(HARD_EDGE)
    most_stretch: FloatProperty(name="Most Stretch", description=ABOUT["most_stretch"], min=0.0, soft_max=10.0)


class HOLOMORPH_OT_tile(TileProperties, _MapsOperator, bpy.types.Operator):
    """Make a UV map on which a texture that tiles shows no seam, keeps its angles and has about the same size
    everywhere. Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_tile"
    bl_label = "Seamless Tiling"
    bl_options = {"REGISTER", "UNDO", "PRESET"}


@bpy.app.handlers.persistent
def _forget_solves(*_arguments):
    """Drops the solves that were kept for the old file: another file has other meshes."""
    if native.problem():
        return
    from ..solving import jobs

    jobs.KEPT.clear()


_register, _unregister = bpy.utils.register_classes_factory(
    [HOLOMORPH_OT_maps, HOLOMORPH_OT_islands, HOLOMORPH_OT_tile]
)


def register():
    _register()
    bpy.app.handlers.load_pre.append(_forget_solves)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget_solves)
    _unregister()
    _forget_solves()
