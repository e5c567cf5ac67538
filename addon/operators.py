# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: one computes the maps, one brings the artist's materials back."""

import bpy
from bpy.props import BoolProperty, FloatProperty, FloatVectorProperty, IntProperty

from . import native

MODAL_FACES = 20_000  # below, a solve is too short to be worth a progress display
TIMER_SECONDS = 0.05
DIALS = 8


class HOLOMORPH_OT_maps(bpy.types.Operator):
    """Compute conformal UV maps for the closed surfaces with handles among the selected meshes.
    Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_maps"
    bl_label = "Holomorphic UV Maps"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    forms: IntProperty(
        name="Form Maps",
        description="At most so many maps of single forms, besides the main map; a surface of genus g has g",
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
        description="Factor of all UV lengths; at 1 each connected part has UV area 1",
        default=1.0,
        min=1e-4,
        soft_min=0.1,
        soft_max=10.0,
    )
    rotation: FloatProperty(name="Rotation", description="Turns all maps", subtype="ANGLE", unit="ROTATION")
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
        description="Angle by which each form's share in the main map is turned",
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
        for name in ("density", "rotation", "forms", "shown", "checker", "checker_scale", "seams"):
            layout.prop(self, name)
        for index in range(min(self.form_count, DIALS)):
            row = layout.row(align=True)
            row.prop(self, "amounts", index=index, text=f"Form {index + 1}")
            row.prop(self, "turns", index=index, text="")

    def execute(self, context):
        """Solves here and now: for scripts, small meshes, and the redo panel (where the solve is kept)."""
        from . import jobs, run

        targets = self._collect(context)
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            job = jobs.Job(run.polygons_to_solve(targets), lambda fraction, _stage: manager.progress_update(fraction))
            job.run()
        finally:
            manager.progress_end()
        return self._write(context, targets, job.results)

    def invoke(self, context, _event):
        from . import cache, jobs, run

        targets = self._collect(context)
        waiting = [p for p in run.polygons_to_solve(targets) if cache.find(p.fingerprint) is None]
        faces = sum(len(p.face_offsets) - 1 for p in waiting)
        if bpy.app.background or context.window is None or faces < MODAL_FACES:
            return self.execute(context)
        self._targets = targets
        self._job = jobs.Job(run.polygons_to_solve(targets))
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
        from . import run

        return run.collect(run.mesh_objects(context))

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

        map_options = maps.MapOptions(self.forms, self.density, self.rotation, tuple(self.amounts), tuple(self.turns))
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
