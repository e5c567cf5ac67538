# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators on two objects: whether they are conformally equivalent, and a UV map carried from one to the other."""

from itertools import islice

import bpy
from bpy.props import FloatProperty

from .. import native
from .mixins import WorkOperator


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


class HOLOMORPH_OT_carry(TwoMeshes, WorkOperator, bpy.types.Operator):
    """Give the active mesh the UV map of the other selected mesh, by the conformal map between the two, which keeps
    all angles. For two meshes of one shape, such as a simplification, a bent or a mirrored copy, with handles or
    holes"""

    bl_idname = "object.holomorphic_carry"
    bl_label = "Transfer UVs Conformally"

    tolerance: FloatProperty(
        name="Tolerance",
        description="Allowed difference between the periods of the two surfaces, which no map removes",
        subtype="PERCENTAGE",
        default=5.0,
        min=0.0,
        soft_max=20.0,
        max=100.0,
    )

    def draw_options(self, layout, _obj):
        layout.prop(self, "tolerance")

    def prepare(self, context):
        from .. import compatibility
        from ..scene import gathering, uv_maps

        taking, given = gathering.active_first(context, gathering.selected_meshes(context))
        layer = given.data.uv_layers.active
        if layer is None:
            raise ValueError(f"{given.name} has no UV map")
        reason = gathering.why_fixed(taking)
        if reason:
            raise ValueError(f"{taking.name}: {reason}")
        if len(taking.data.uv_layers) >= compatibility.UV_MAP_LIMIT:
            raise ValueError(f"{taking.name} has {compatibility.UV_MAP_LIMIT} UV maps, the most that Blender allows")
        self._sides = self.read_sides([given, taking])
        self._map = layer.name
        self._uv = uv_maps.read_corners(given.data, self._sides[0].polygons, layer.name)
        self._taking = taking.name, taking.library.filepath if taking.library else None

    def make_work(self, progress):
        from ..maps import comparison

        return comparison.CarriedMap(*self._sides, self._uv, self.tolerance / 100, progress)

    def written_objects(self):
        obj = bpy.data.objects.get(self._taking)
        return [] if obj is None else [obj]

    def finish(self, step, work, time_has_passed):
        from ..scene import targets, uv_maps

        given, taking = self._sides
        obj = bpy.data.objects.get(self._taking)
        problem = native.sentence(work.error) if work.error else ""
        if obj is None or (time_has_passed and not targets.read(obj).equals(taking.polygons)):
            problem = f"{taking.name} changed during the run; please run it again"
        if problem:
            return self.refuse(problem)
        written = uv_maps.write_map(obj.data, taking.polygons, self._map, work.uv)
        uv_maps.show_map(obj.data, written.name)
        source = step.context.scene.objects.get(given.name)
        if source is not None and not any(obj.data.materials) and source.active_material is not None:
            obj.active_material = source.active_material
        obj.data.update()
        self.report({"INFO"}, f'{given.name} to {taking.name}, UV map "{written.name}": {work.found.sentence}')
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_compare, HOLOMORPH_OT_carry])
