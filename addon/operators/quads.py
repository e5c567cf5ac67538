# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes a mesh of quads over the active mesh."""

import bpy
from bpy.props import BoolProperty, IntProperty

from .. import native
from .mixins import WorkOperator

ABOUT = {
    "faces": "About how many quads, over all parts",
    "keep": "Let edges run along hard edges, edges marked sharp, and borders, where that fits",
    "mirror": "Make two halves that are alike, of a mesh that is its own mirror image",
}


class HOLOMORPH_OT_quads(WorkOperator, bpy.types.Operator):
    """Make a mesh of even quads over the active mesh, as an object of its own with its materials, weights and UV maps.
    It needs no map"""

    bl_idname = "object.holomorphic_quads"
    bl_label = "Quads"

    faces: IntProperty(name="Faces", description=ABOUT["faces"], default=2000, min=6, soft_max=100_000)
    keep_edges: BoolProperty(name="Keep Hard Edges", description=ABOUT["keep"], default=True)
    mirror: BoolProperty(name="Mirror", description=ABOUT["mirror"], default=False)

    @classmethod
    def why_not(cls, context):
        obj = context.view_layer.objects.active
        return "" if obj is not None and obj.type == "MESH" else "Make a mesh object active"

    def draw_options(self, layout, _obj):
        for name in ("faces", "keep_edges", "mirror"):
            layout.prop(self, name)

    def prepare(self, context):
        from ..scene import targets

        (self._target,) = targets.collect([context.view_layer.objects.active])
        if self._target.refused:
            raise ValueError(f"{self._target.name}: {self._target.refused}")

    def make_work(self, progress):
        from ..things import quads

        target, lines = self._target, "whole" if self.keep_edges else "none"
        return quads.QuadsWork(target.polygons, self.faces, lines, self.mirror, target.sharp, progress)

    def waiting_faces(self):
        return self._target.polygons.face_count

    def written_objects(self):
        from ..scene import targets

        return targets.objects([self._target])

    def finish(self, step, work, time_has_passed):
        from ..things import quads

        name = self._target.name
        if work.error is not None:
            return self.refuse(f"{name}: {native.sentence(work.error)}")
        if self._target.has_changed(time_has_passed):
            return self.refuse(f"{name}: it changed while its quads were made; please run it again")
        made = quads.write(step, self._target.find(), work.made)
        for sentence in work.made.notes:
            self.report({"WARNING"}, f"{name}: {sentence}")
        self.report({"INFO"}, f"{made.name}: {work.made.sentence}")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_quads])
