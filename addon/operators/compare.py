# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that says whether two objects are conformally equivalent."""

from itertools import islice

import bpy

from .. import native
from .modal import WorkOperator


class TwoMeshes:
    """A mixin: an operator on the two selected meshes, in all modes."""

    @classmethod
    def why_not(cls, context):
        from ..scene import gathering

        return "" if len(list(islice(gathering.selected_meshes(context), 3))) == 2 else "Select two meshes"

    @staticmethod
    def read_sides(objects):
        from ..maps import comparison
        from ..scene import targets

        return [comparison.Side(o.name, targets.read(o), o.matrix_world.determinant() < 0) for o in objects]

    def waiting_faces(self):
        return sum(side.polygons.face_count for side in self._sides)


class HOLOMORPH_OT_compare(TwoMeshes, WorkOperator, bpy.types.Operator):
    """Find out whether a map between the two selected meshes keeps all angles: whether they are the same
    surface, mirror images, different, or cannot be told apart at this resolution"""

    bl_idname = "object.holomorphic_compare"
    bl_label = "Compare Conformally"
    bl_options = {"REGISTER"}

    def draw_options(self, _layout, _obj):
        """There are none."""

    def prepare(self, context):
        from ..scene import gathering

        self._sides = self.read_sides(gathering.active_first(context, gathering.selected_meshes(context)))

    def make_work(self, progress):
        from ..maps import comparison

        return comparison.Comparison(self._sides, progress)

    def written_objects(self):
        return []

    def finish(self, _step, work, time_has_passed):
        if work.error:
            return self.refuse(native.sentence(work.error))
        first, second = self._sides
        self.report({"INFO"}, f"{first.name}, {second.name}: {work.found.sentence}")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_compare])
