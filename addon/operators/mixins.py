# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators share: whether one can run here, which Blender shows where its button is grey; what it says in the
end; work in a worker thread, while Blender's window stays alive."""

import functools
import math

import bpy

from .. import native, preferences

TAB = "Holomorph"  # of the sidebars
CONVERTIBLE = {"FONT", "CURVE", "SURFACE", "META"}
CONVERT = "Convert this to a mesh first: Object > Convert > Mesh"
INSTANCES = "Turn these into meshes first: Object > Apply > Make Instances Real"
PAINTING = {"SCULPT", "PAINT_VERTEX", "PAINT_WEIGHT", "PAINT_TEXTURE", "PARTICLE"}  # modes that are left meanwhile
DYNTOPO = "Turn Dyntopo off: it does not keep UV maps"


class Explained:
    """A mixin for operators. One of them defines

    why_not(context) : class method; why it cannot run here, one sentence, or ""
    """

    bl_options = {"REGISTER", "UNDO"}
    needs_library = True
    modes = {"OBJECT": "Object Mode"}  # in which it can run, as menus name them; none for any
    left_modes = PAINTING  # further ones: it leaves them and comes back
    outcome = None  # the `write.Outcome` of the class's last run, for what has no window to show it

    @classmethod
    def poll(cls, context):
        sentence = native.problem() if cls.needs_library else ""
        sentence = sentence or cls._other_mode(context) or cls.why_not(context)
        if sentence:
            cls.poll_message_set(sentence)
        return not sentence

    @classmethod
    def _other_mode(cls, context):
        if not cls.modes or context.mode in cls.modes:
            return ""
        if context.mode in cls.left_modes:
            return DYNTOPO if context.object.use_dynamic_topology_sculpting else ""
        return f"Switch to {' or '.join(cls.modes.values())}"

    def __init_subclass__(cls, **options):
        """What Blender calls is the outer door: an error that nothing foresaw is told there."""
        super().__init_subclass__(**options)
        for name in ("execute", "invoke", "modal"):
            if name in cls.__dict__:
                setattr(cls, name, _guarded(cls.__dict__[name]))

    def refuse(self, sentence):
        """Says why nothing is done, and gives what the operator returns."""
        self.report({"ERROR"}, str(sentence))
        return {"CANCELLED"}

    def tell(self, outcome):
        """Reports a `write.Outcome`, and gives what the operator returns."""
        type(self).outcome = outcome
        for window in bpy.context.window_manager.windows:  # sidebars do not see that there is a report, nor editors UVs
            for area in window.screen.areas:
                area.tag_redraw()
        from ..results import write

        problems, notes = write.in_short(outcome.problems), write.in_short(outcome.notes)
        if not outcome.done:
            return self.refuse("; ".join(problems) or "No mesh selected")
        for sentence in problems:
            self.report({"WARNING"}, sentence)
        for sentence in notes:
            self.report({"INFO"}, sentence)
        if not outcome.problems and not outcome.notes:
            self.report({"INFO"}, f"Holomorphic UV maps written: {', '.join(outcome.done)}")
        return {"FINISHED"}


def redraw_sidebars(context):
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            for region in area.regions:
                if region.type == "UI":
                    region.tag_redraw()


def _is_in_our_tab(context, event):
    """Whether the pointer is in a sidebar that shows our tab."""
    from .. import compatibility

    for region in (region for area in context.window.screen.areas for region in area.regions):
        x, y = event.mouse_x - region.x, event.mouse_y - region.y
        if 0 <= x < region.width and 0 <= y < region.height and compatibility.shows_tab(region, TAB):
            return True
    return False


def _guarded(method):
    """The method, with as many arguments, for Blender counts them; after an error it refuses in one sentence."""

    def call(operator, *arguments):
        try:
            return method(operator, *arguments)
        except MemoryError as error:
            return operator.refuse(" ".join(["There is not enough memory.", *getattr(error, "__notes__", ())]))
        except Exception as error:  # noqa: BLE001  nobody is left to raise it to
            return operator.refuse(native.fault(error))

    if method.__code__.co_argcount == 2:
        return functools.wraps(method)(lambda self, context: call(self, context))
    return functools.wraps(method)(lambda self, context, event: call(self, context, event))


class OnMeshes(Explained):
    """A mixin: an operator on the selected meshes, or on those in edit mode."""

    modes = {"OBJECT": "Object Mode", "EDIT_MESH": "Edit Mode"}

    @classmethod
    def why_not(cls, context):
        from .. import compatibility
        from ..scene import gathering

        if gathering.has_candidates(context):
            return ""
        selected = compatibility.selected_in(context.view_layer)
        if any(o.instance_type == "COLLECTION" for o in selected):
            return INSTANCES
        return CONVERT if any(o.type in CONVERTIBLE for o in selected) else "Select a mesh"


class AtOnce(OnMeshes):
    """A mixin: an operator whose work is so quick that it is done at once. One of them defines

    act(step, objects) : changes these mesh objects in a `transaction.Step`, in object mode; returns whether there was
        something to do
    """

    nothing = ""  # what is said where there was nothing to do; "" where `act` says it

    def read(self, _context, objects):
        """The objects among these that `act` may change. Whatever it needs of edit mode is read here."""
        return objects

    def execute(self, context):
        from ..scene import gathering
        from ..writing import transaction

        reasons = {obj: gathering.why_fixed(obj) for obj in gathering.mesh_objects(context)}
        for obj, reason in reasons.items():
            if reason:
                self.report({"WARNING"}, f"{obj.name}: {reason}")
        objects = self.read(context, [obj for obj, reason in reasons.items() if not reason])
        with transaction.one_step(context, objects) as step:
            has_acted = self.act(step, objects)
        if objects and not has_acted and self.nothing:
            self.report({"INFO"}, self.nothing)
        return {"FINISHED"} if has_acted else {"CANCELLED"}


MODAL_FACES = 20_000  # below, a solve is too short to be worth a progress display
MODAL_TILED_FACES = 2_000  # likewise a tiling
TIMER_SECONDS = 0.05
OF_A_CLICK = {"MOUSEMOVE", "LEFTMOUSE"}


class WorkOperator(Explained):
    """A mixin for operators. One of them defines, beside `why_not`,

    draw_options(layout, obj) : its options in the redo panel, with the active object
    prepare(context) : reads what the work needs; raises ValueError where there is none, with one sentence why
    make_work(progress) : a `jobs.Work` of what was read
    waiting_faces() : how many polygons there are to solve; from `modal_faces` on this is done in the background
    written_objects() : those that it may change
    finish(step, work, time_has_passed) : writes the results, in a `transaction.Step`; the set that an operator returns
    """

    running = None  # the `jobs.Work` of the one that works in the background

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
            self._check_numbers()
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
        WorkOperator.running = self._work
        self._work.start()
        return {"RUNNING_MODAL"}

    def _check_numbers(self):
        """Blender takes any float of a script, whatever the limits. @throws ValueError"""
        for known in self.properties.bl_rna.properties:
            if known.type != "FLOAT":
                continue
            value = getattr(self, known.identifier)
            for number in value if known.is_array else (value,):
                if not math.isfinite(number):
                    raise ValueError(f"{known.name} is {number}; a finite number is needed")

    def modal(self, context, event):
        """Until the worker is done, the meshes stay as they were read: of all events Blender gets clicks in our tab
        alone, where nothing but a button that stops the work can be pressed."""
        try:
            return self._after(context, event)
        except BaseException:
            self.cancel(context)
            raise

    def _after(self, context, event):
        if event.type == "ESC" or self._work.watch.is_cancelled:
            self.cancel(context)
            self.report({"INFO"}, "Cancelled: nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            is_passed = event.type in OF_A_CLICK and _is_in_our_tab(context, event)
            return {"PASS_THROUGH"} if is_passed else {"RUNNING_MODAL"}
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
        from ..materials import material

        own = preferences.of(context)
        is_wanted = own is None or own.show_in_viewport
        if outcome.done and has_texture and context.window is not None and is_wanted:
            material.show_in_views(context.window, material.MATERIAL_VIEW if is_own else material.SOLID_VIEW)

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
        context.workspace.status_text_set(f"Holomorph: {percent} %   (ESC stops)")
        context.window_manager.progress_update(self._work.watch.fraction)
        redraw_sidebars(context)

    def _end_modal(self, context):
        WorkOperator.running = None
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        redraw_sidebars(context)
