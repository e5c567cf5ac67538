# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators whose work runs in a worker thread while Blender's window stays alive."""

import bpy

from .availability import Explained

MODAL_FACES = 20_000  # below, a solve is too short to be worth a progress display
MODAL_TILED_FACES = 2_000  # likewise a tiling
TIMER_SECONDS = 0.05


class WorkOperator(Explained):
    """A mixin for operators. One of them defines, beside `why_not`,

    draw_options(layout, obj) : its options in the redo panel, with the active object
    prepare(context) : reads what the work needs; raises ValueError where there is none, with one sentence why
    make_work(progress) : a `jobs.Work` of what was read
    waiting_faces() : how many polygons there are to solve; from `modal_faces` on this is done in the background
    written_objects() : those that it may change
    finish(step, work, time_has_passed) : writes the results, in a `transaction.Step`; the set that an operator returns
    """

    def modal_faces(self):
        return MODAL_FACES

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.draw_options(self.layout, context.object)

    def execute(self, context):
        """Works here and now: for scripts, small meshes, and the redo panel (where solves are cached)."""
        return self._begin(context, is_here=True)

    def invoke(self, context, _event):
        return self._begin(context, is_here=bpy.app.background or context.window is None)

    def _begin(self, context, is_here):
        try:
            self.prepare(context)
        except ValueError as error:
            return self.refuse(error)
        if is_here or self.waiting_faces() < self.modal_faces():
            return self._work_here(context)
        self._work = self.make_work(None)
        manager = context.window_manager
        self._timer = manager.event_timer_add(TIMER_SECONDS, window=context.window)
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        self._work.start()
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Consumes every event but ESC until the worker is done, so the meshes stay as they were read."""
        try:
            return self._after(context, event)
        except BaseException:
            self.cancel(context)
            raise

    def _after(self, context, event):
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Cancelled: nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        if self._work.is_running():
            self._show_progress(context)
            return {"RUNNING_MODAL"}
        self._end_modal(context)
        self._work.wait()
        return self._finish(context, self._work, time_has_passed=True)

    def cancel(self, context):
        """Called on ESC, when another file is loaded, or when the program ends in the middle of the work.

        The worker is not waited for: it may be inside a factorisation, which is not interrupted. It uses nothing
        of Blender's, and ends by itself at the library's next progress call.
        """
        self._work.cancel()
        self._end_modal(context)

    def show(self, context, outcome, has_texture, is_own=False):
        """Switches the window's 3D views so that the texture of what was done is seen, or the user's own material."""
        from .. import preferences
        from ..materials import viewport

        if outcome.done and has_texture and context.window is not None and preferences.shows_in_viewport(context):
            viewport.show(context.window, viewport.MATERIAL if is_own else viewport.IMAGE)

    def _work_here(self, context):
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            work = self.make_work(manager.progress_update)
            work.run()
        finally:
            manager.progress_end()
        return self._finish(context, work, time_has_passed=False)

    def _finish(self, context, work, time_has_passed):
        from ..writing import transaction

        with transaction.one_step(context, self.written_objects()) as step:
            return self.finish(step, work, time_has_passed)

    def _show_progress(self, context):
        percent = round(100 * self._work.watch.fraction)
        context.workspace.status_text_set(f"Holomorph: {percent} % {self._work.watch.stage}   (ESC cancels)")
        context.window_manager.progress_update(self._work.watch.fraction)

    def _end_modal(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
