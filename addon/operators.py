# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: one computes the maps, one brings the artist's materials back."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from . import native

MODAL_FACES = 20_000  # below, a solve is too short to be worth a progress display
TIMER_SECONDS = 0.05
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
)


DRAWN = (  # in groups
    ("density", "margin", "rotation", "forms", "shown"),
    ("checker", "checker_scale", "seams"),
    ("use_selection", "residues", "cut_at_seams", "boundary", "solver"),
)


class HOLOMORPH_OT_maps(bpy.types.Operator):
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
    use_selection: EnumProperty(
        name="Use Selection", description="What the selected vertices are", items=SELECTION_USES, default="AUTOMATIC"
    )
    residues: StringProperty(
        name="Residues",
        description="One number for each puncture, in the order of selection, for example 1 1 -2; they sum to 0 on a "
        "closed surface, and may be complex (1+0.5j). Empty: chosen by themselves",
        default="",
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

    def execute(self, context):
        """Solves here and now: for scripts, small meshes, and the redo panel (where the solve is kept)."""
        from . import jobs, run

        targets = self._collect(context)
        if targets is None:
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            job = jobs.Job(run.tasks(targets), lambda fraction, _stage: manager.progress_update(fraction))
            job.run()
        finally:
            manager.progress_end()
        return self._write(context, targets, job.results)

    def invoke(self, context, _event):
        from . import cache, jobs, run

        targets = self._collect(context)
        if targets is None:
            return {"CANCELLED"}
        waiting = [task.polygons for task in run.tasks(targets) if cache.find(task.key) is None]
        faces = sum(len(p.face_offsets) - 1 for p in waiting)
        if bpy.app.background or context.window is None or faces < MODAL_FACES:
            return self.execute(context)
        self._targets = targets
        self._job = jobs.Job(run.tasks(targets))
        manager = context.window_manager
        self._timer = manager.event_timer_add(TIMER_SECONDS, window=context.window)
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        self._job.start()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Every event but ESC is held back until the worker is done, so the meshes stay as they were read."""
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Cancelled: nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._job.is_running():
            self._show_progress(context)
            return {"RUNNING_MODAL"}
        self._end_modal(context)
        self._job.wait()
        return self._write(context, self._targets, self._job.results, time_has_passed=True)

    def cancel(self, context):
        """ESC, or another file is loaded, or the program ends in the middle of a solve.

        The worker is not waited for: it may be inside a factorisation, which is not interrupted. It has nothing
        of Blender's in its hands, and ends by itself at the library's next question.
        """
        self._job.cancel()
        self._end_modal(context)

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

    def _show_progress(self, context):
        percent = round(100 * self._job.fraction)
        context.workspace.status_text_set(f"Holomorph: {percent} % {self._job.stage}   (ESC cancels)")
        context.window_manager.progress_update(self._job.fraction)

    def _end_modal(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _write(self, context, targets, results, time_has_passed=False):
        from . import maps, run

        map_options = maps.MapOptions(
            self.forms, self.density, self.rotation, tuple(self.amounts), tuple(self.turns), self.margin
        )
        write_options = run.WriteOptions(self.shown, self.checker, self.checker_scale, self.seams)
        outcome = run.write(context, targets, run.align(targets, results), map_options, write_options, time_has_passed)
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
