# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator for seamless tilings of the selected meshes."""

from functools import partial

import bpy

from .availability import OnMeshes
from .modal import MODAL_TILED_FACES, WorkOperator
from .tile_properties import TileProperties


class HOLOMORPH_OT_tile(TileProperties, OnMeshes, WorkOperator, bpy.types.Operator):
    """Make a UV map on which a texture that tiles shows no seam, keeps its angles and has about the same size
    everywhere. Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_tile"
    bl_label = "Seamless Tiling"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    def prepare(self, context):
        from ..scene import faces, targets

        is_selection_taken = self.poles == "SELECTED" or self.direction == "EDGES"
        wanted = faces.WHOLE if is_selection_taken else faces.SELECTED
        request = targets.Request(faces=wanted, modifiers=self.modifiers)
        self._targets = targets.collect(targets.mesh_objects(context), request)
        try:
            self._options = [self.tile_options(target) for target in self._targets if not target.refused]
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def make_work(self, progress):
        from ..maps import tiling
        from ..scene import targets
        from ..solving import jobs

        tile = tiling.Evenly() if self.equal else tiling.tile
        then = [partial(tile, options=options) for options in self._options]
        return jobs.Job(targets.tasks(self._targets), progress, then)

    def waiting_faces(self):
        from ..scene import targets

        return sum(task.polygons.face_count for task in targets.tasks(self._targets))

    def modal_faces(self):
        return MODAL_TILED_FACES

    def finish(self, context, work, time_has_passed):
        from ..results import tile_run
        from ..scene import targets
        from . import tile_choices

        results = targets.align(self._targets, work.results)
        options = tile_run.TileWriteOptions(
            tile_choices.written_quarters(self),
            self.checker,
            self.texture,
            self.repeats,
            self.seams,
            self.empties,
            self.pole_group,
        )
        outcome = tile_run.write(context, self._targets, results, options, time_has_passed)
        self.show(context, outcome, self.checker)
        return self.tell(outcome)


def register():
    bpy.utils.register_class(HOLOMORPH_OT_tile)


def unregister():
    bpy.utils.unregister_class(HOLOMORPH_OT_tile)
