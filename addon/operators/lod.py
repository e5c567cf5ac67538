# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator for levels of detail of the active object, with UV maps that stay in place."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .mixins import WorkOperator

ABOUT = {
    "levels": "Number of levels",
    "ratio": "Triangles of each level, as a share of the level before",
    "side_by_side": "Place the levels in a row along X beside the object. Off: at its location, as engines expect",
    "hidden": "Hide the levels in the viewport and in renders; the eye icons in the Outliner show them",
}


class HOLOMORPH_OT_levels(WorkOperator, bpy.types.Operator):
    """Make coarser triangle meshes of the active object on which every texture stays in place: vertices and seams
    that remain keep their UVs. Makes the map "Holomorphic" first where there is none.
    Levels of an earlier run are replaced"""

    bl_idname = "object.holomorphic_levels"
    bl_label = "Holomorphic Levels of Detail"

    levels: IntProperty(name="Levels", description=ABOUT["levels"], default=4, min=1, max=12)
    ratio: FloatProperty(name="Ratio", description=ABOUT["ratio"], default=0.25, min=0.01, max=0.95)
    side_by_side: BoolProperty(name="Side by Side", description=ABOUT["side_by_side"], default=True)
    hidden: BoolProperty(name="Hidden", description=ABOUT["hidden"], default=True)

    @classmethod
    def why_not(cls, context):
        obj = context.view_layer.objects.active
        return "" if obj is not None and obj.type == "MESH" else "Make a mesh object active"

    def draw_options(self, layout, _obj):
        for name in ("levels", "ratio", "side_by_side", "hidden"):
            layout.prop(self, name)

    def prepare(self, context):
        from ..levels import level_objects

        self._source = level_objects.Source(context.view_layer.objects.active)
        if self._source.refused:
            raise ValueError(f"{self._source.target.name}: {self._source.refused}")

    def make_work(self, progress):
        from ..levels import levels

        return self._source.work(levels.LevelOptions(self.levels, self.ratio), progress)

    def waiting_faces(self):
        return self._source.target.polygons.face_count

    def written_objects(self):
        from ..scene import targets

        return targets.objects([self._source.target])

    def finish(self, step, work, time_has_passed):
        from ..levels import level_objects

        name, presentation = (
            self._source.target.name,
            level_objects.Presentation(self.side_by_side, self.hidden),
        )
        made, told = self._source.write(step, work, presentation, time_has_passed)
        if not made:
            return self.refuse(f"{name}: {told[0]}")
        for sentence in told:
            self.report({"WARNING"}, sentence)
        counts = ", ".join(str(len(level.surface.triangles)) for level in work.levels)
        kept = f"; {name} cannot be made coarser" if len(work.levels) < self.levels else ""
        self.report({"INFO"}, f"{name}: levels of {counts} triangles{kept}")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_levels])
