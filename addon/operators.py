# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: one computes the maps, one brings the artist's materials back."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from . import native
from .modal import WorkOperator

DIALS = 8

SELECTION_USES = (
    (
        "AUTOMATIC",
        "Automatic",
        "In edit mode: four selected boundary vertices of a disk become the corners of a rectangle, other single "
        "vertices punctures. Selected edges and faces, and vertices that do not fit, are no choice",
    ),
    (
        "PUNCTURES",
        "Punctures",
        "The texture runs around each selected vertex, and its density grows towards it without end: at least two on "
        "a closed surface, one on a disk",
    ),
    (
        "RECTANGLE",
        "Rectangle",
        "The four selected vertices on the boundary of a disk become the corners of an exact rectangle",
    ),
    ("NONE", "None", "The selection does not matter"),
)
BOUNDARIES = (
    ("natural", "Natural", "Solve on the surface itself: fast"),
    (
        "double_cover",
        "Double Cover",
        "Glue two copies of the surface along the boundary and solve on the closed "
        "double: the same result at more than twice the cost",
    ),
)
SOLVERS = (
    ("auto", "Automatic", "By size and number of forms"),
    ("direct", "Direct", "Sparse Cholesky factorisation"),
    ("multigrid", "Multigrid", "Linear time and memory"),
    ("paper", "Paper", "The published multiresolution method, on closed parts with handles: for comparison"),
)


DRAWN = (  # in groups
    ("density", "margin", "rotation", "forms", "shown"),
    ("checker", "checker_scale", "seams", "shape"),
    ("use_selection", "residues", "cut_at_seams", "boundary", "solver"),
)


class HOLOMORPH_OT_maps(WorkOperator, bpy.types.Operator):
    """Compute conformal UV maps for the selected meshes, whatever their shape.
    Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_maps"
    bl_label = "Holomorphic UV Maps"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    forms: IntProperty(
        name="Form Maps",
        description="At most so many maps of single forms, besides the main map; a closed surface of genus g has g, "
        "one with b boundary loops 2 g + b - 1",
        default=8,
        min=0,
        soft_max=32,
    )
    shown: IntProperty(
        name="Shown Map",
        description="The map that becomes active: 0 is the main map, 1 the first form",
        default=0,
        min=0,
        soft_max=8,
    )
    density: FloatProperty(
        name="Density",
        description="Factor of all UV lengths; at 1 the parts fill the UV square together, with equal texel density",
        default=1.0,
        min=1e-4,
        soft_min=0.1,
        soft_max=10.0,
    )
    margin: FloatProperty(
        name="Margin",
        description="Distance between connected parts, as a share of the UV square; less where there are many",
        default=0.02,
        min=0.0,
        max=0.2,
    )
    rotation: FloatProperty(
        name="Rotation", description="Turns every part of all maps", subtype="ANGLE", unit="ROTATION"
    )
    # Not remembered for the next object, unlike the other options: that has a selection of its own.
    use_selection: EnumProperty(
        name="Use Selection",
        description="What the selected vertices are",
        items=SELECTION_USES,
        default="AUTOMATIC",
        options={"SKIP_SAVE"},
    )
    residues: StringProperty(
        name="Residues",
        description="One number for each puncture, in the order of selection, for example 1 1 -2; they sum to 0 on a "
        "closed surface, and may be complex (1+0.5j). Empty: chosen by themselves",
        default="",
        options={"SKIP_SAVE"},
    )
    cut_at_seams: BoolProperty(
        name="Use Seams as Cut",
        description="Cut the maps along your seams where these make each part a disk; else the report says why not",
        default=False,
    )
    boundary: EnumProperty(
        name="Boundary", description="How surfaces with a boundary are solved", items=BOUNDARIES, default="natural"
    )
    solver: EnumProperty(name="Solver", description="How the linear systems are solved", items=SOLVERS, default="auto")
    amounts: FloatVectorProperty(
        name="Amount",
        description="Factor of each form's share in the main map; at 1 the density is most even",
        size=DIALS,
        default=(1.0,) * DIALS,
        soft_min=0.0,
        soft_max=4.0,
    )
    turns: FloatVectorProperty(
        name="Turn",
        description="Angle by which each form's share in the main map is turned; boundaries stay straight all the same",
        size=DIALS,
        default=(0.0,) * DIALS,
        subtype="EULER",
        unit="ROTATION",
    )
    checker: BoolProperty(
        name="Checker",
        description="Show the map with a checker; the mesh's own materials stay and can be brought back",
        default=True,
    )
    checker_scale: FloatProperty(
        name="Squares",
        description="Checker squares per UV unit; 0 chooses a number that suits the object's size",
        default=0.0,
        min=0.0,
        soft_max=200.0,
    )
    seams: BoolProperty(
        name="Mark Seams",
        description="Mark the edges where the maps are cut as seams; existing seams are kept",
        default=False,
    )
    shape: BoolProperty(
        name="Store Shape",
        description="Store the conformal map to the unit sphere (parts without handles and holes) or to the unit disk "
        "as a vector attribute of the vertices, for Geometry Nodes",
        default=False,
    )
    form_count: IntProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        if native.problem():
            cls.poll_message_set(native.problem())
            return False
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            cls.poll_message_set("Go to Object Mode or Edit Mode")
            return False
        objects = context.view_layer.objects
        edited = context.mode == "EDIT_MESH"
        if not edited and not any(o.type == "MESH" for o in objects.selected):
            cls.poll_message_set("Select a mesh")
            return False
        return True

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for group in DRAWN:
            column = layout.column()
            for name in group:
                column.prop(self, name)
        for index in range(min(self.form_count, DIALS)):
            row = layout.row(align=True)
            row.prop(self, "amounts", index=index, text=f"Form {index + 1}")
            row.prop(self, "turns", index=index, text="")

    def prepare(self, context):
        self._targets = self._collect(context)
        return self._targets is not None

    def make_work(self, progress):
        from . import jobs, run

        return jobs.Job(run.tasks(self._targets), progress)

    def waiting_faces(self):
        from . import cache, run

        waiting = [task.polygons for task in run.tasks(self._targets) if cache.find(task) is None]
        return sum(len(p.face_offsets) - 1 for p in waiting)

    def _collect(self, context):
        """The targets, or None where the residues cannot be read."""
        from . import choices, run

        try:
            residues = choices.numbers(self.residues)
        except ValueError as error:
            self.report({"ERROR"}, f"Residues: {error}")
            return None
        request = run.Request(
            use=self.use_selection,
            residues=residues,
            cut_at_seams=self.cut_at_seams,
            boundary=self.boundary,
            solver=self.solver,
        )
        return run.collect(run.mesh_objects(context), request)

    def finish(self, context, work, time_has_passed):
        from . import maps, run

        map_options = maps.MapOptions(
            self.forms, self.density, self.rotation, tuple(self.amounts), tuple(self.turns), self.margin
        )
        write_options = run.WriteOptions(self.shown, self.checker, self.checker_scale, self.seams, self.shape)
        results = run.align(self._targets, work.results)
        outcome = run.write(context, self._targets, results, map_options, write_options, time_has_passed)
        self.form_count = outcome.forms
        if not outcome.done:
            self.report({"ERROR"}, "; ".join(outcome.problems) or "No mesh selected")
            return {"CANCELLED"}
        for sentence in outcome.problems:
            self.report({"WARNING"}, sentence)
        for sentence in outcome.notes:
            self.report({"INFO"}, sentence)
        if not outcome.problems and not outcome.notes:
            self.report({"INFO"}, f"Holomorphic UV maps written: {', '.join(outcome.done)}")
        return {"FINISHED"}


class HOLOMORPH_OT_restore_materials(bpy.types.Operator):
    """Bring back the materials that the checker covers"""

    bl_idname = "uv.holomorphic_restore_materials"
    bl_label = "Restore Materials"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode in {"OBJECT", "EDIT_MESH"}

    def execute(self, context):
        from . import material, run

        restored = [material.remove_checker(obj) for obj in run.mesh_objects(context)]
        return {"FINISHED"} if any(restored) else {"CANCELLED"}


@bpy.app.handlers.persistent
def _forget_solves(*_arguments):
    """Another file has other meshes; what was kept for the old one would only take memory."""
    if native.problem():
        return
    from . import cache

    cache.clear()


CLASSES = (HOLOMORPH_OT_maps, HOLOMORPH_OT_restore_materials)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.app.handlers.load_pre.append(_forget_solves)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget_solves)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    _forget_solves()
