# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator for levels of detail of the active object, with UV maps that stay in place."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from .. import native
from .modal import WorkOperator


class HOLOMORPH_OT_levels(WorkOperator, bpy.types.Operator):
    """Make coarser copies of the active object, of triangles, on which every texture stays in place: UV maps have the
    same values at the same vertices and the same seams. Where there is no map "Holomorphic" it is made first.
    Levels of an earlier run are replaced"""

    bl_idname = "object.holomorphic_levels"
    bl_label = "Holomorphic Levels of Detail"
    bl_options = {"REGISTER", "UNDO"}

    levels: IntProperty(name="Levels", description="How many levels are made", default=4, min=1, max=12)
    ratio: FloatProperty(
        name="Ratio",
        description="Triangles of each level over those of the one before",
        default=0.25,
        min=0.01,
        max=0.95,
    )
    coarsest: IntProperty(
        name="Coarsest",
        description="Triangles of the last level; 0 lets the ratio decide. A surface with handles needs some, and is "
        "never made coarser than that",
        default=0,
        min=0,
    )
    side_by_side: BoolProperty(
        name="Side by Side",
        description="Place the levels in a row along X beside the object. Off: at its location, as engines want them",
        default=True,
    )
    hidden: BoolProperty(
        name="Hidden",
        description="Hide the levels, in the view and in renders: the eyes in the Outliner show them",
        default=True,
    )
    finest: BoolProperty(
        name="Copy as LOD0",
        description="A copy of the object becomes the finest level, Name_LOD0, unless the object itself is called so",
        default=True,
    )

    @classmethod
    def why_not(cls, context):
        if context.mode != "OBJECT":
            return "Go to Object Mode"
        obj = context.view_layer.objects.active
        return "" if obj is not None and obj.type == "MESH" else "Make a mesh object active"

    def draw_options(self, layout, _obj):
        layout.prop(self, "levels")
        row = layout.row()
        row.active = self.coarsest == 0
        row.prop(self, "ratio")
        layout.prop(self, "coarsest")
        for name in ("side_by_side", "hidden", "finest"):
            layout.prop(self, name)

    def prepare(self, context):
        self._source = Source(context.view_layer.objects.active)
        if self._source.target.refused:
            self.report({"ERROR"}, f"{self._source.target.name}: {self._source.target.refused}")
        return not self._source.target.refused

    def make_work(self, progress):
        from ..levels import levels

        return self._source.work(levels.LevelOptions(self.levels, self.ratio, self.coarsest), progress)

    def waiting_faces(self):
        return self._source.target.polygons.face_count

    def written_objects(self):
        from ..scene import targets

        return targets.objects([self._source.target])

    def finish(self, step, work, time_has_passed):
        from ..levels import level_objects

        source, name = self._source, self._source.target.name
        problem = source.problem(work, time_has_passed)
        if problem:
            self.report({"ERROR"}, f"{name}: {problem}")
            return {"CANCELLED"}
        notes = source.write_map(step, work)
        arrangement = level_objects.Arrangement(self.side_by_side, self.hidden, self.finest)
        source.write_levels(step, work, arrangement)
        for sentence in notes:
            self.report({"WARNING"}, sentence)
        counts = ", ".join(str(len(level.surface.triangles)) for level in work.levels)
        kept = f"; {name} allows no coarser one" if len(work.levels) < self.levels else ""
        self.report({"INFO"}, f"{name}: levels of {counts} triangles{kept}")
        return {"FINISHED"}


def make_levels(context, obj, options, **arrangement):
    """Here and now: the objects of the levels, and one sentence where there are none.

    arrangement : of `level_objects.Arrangement`
    """
    from ..levels import level_objects
    from ..writing import transaction

    source = Source(obj)
    if source.target.refused:
        return [], source.target.refused
    work = source.work(options)
    work.run()
    problem = source.problem(work)
    if problem:
        return [], problem
    with transaction.one_step(context, [obj]) as step:
        source.write_map(step, work)
        return source.write_levels(step, work, level_objects.Arrangement(**arrangement)), ""


class Source:
    """The object whose levels are made, as it was when the operator began."""

    def __init__(self, obj):
        from ..levels import transfer
        from ..scene import targets

        (self.target,) = targets.collect([obj])
        self.data = None if self.target.refused else transfer.read(obj.data, self.target.polygons)

    def work(self, options, progress=None):
        from ..levels import levels
        from ..scene import targets

        (task,) = targets.tasks([self.target])
        needs_map = not set(self.data.own_maps) & set(self.data.maps)
        return levels.LevelsWork(task, self.data.maps, self.data.uv, needs_map, options, progress)

    def problem(self, work, time_has_passed=False):
        """Why nothing is written, one sentence, or nothing."""
        if work.error is not None:
            return native.sentence(work.error)
        if self.target.has_changed(time_has_passed):
            return "it was changed while its levels were made; please run it again"
        if not work.names:
            reasons = {part.skipped for part in work.mapped.parts}
            return f"there is no UV map, and none could be made: {'; '.join(sorted(reasons))}"
        if not work.levels:
            return "it has no coarser level"
        return ""

    def write_map(self, step, work):
        """Writes the map that was made to the object itself; sentences about what was not done."""
        from ..results import write

        if work.mapped is None:
            return []
        outcome = write.write(step, [self.target], [work.mapped], write.WriteOptions(checker=False))
        return outcome.problems + outcome.notes

    def write_levels(self, step, work, arrangement):
        """The levels as objects, in a collection of their own."""
        from ..levels import level_objects

        return level_objects.write(step, self.target.find(), self.data, work, arrangement)


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_levels])
