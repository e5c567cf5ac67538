# SPDX-License-Identifier: GPL-3.0-or-later
"""A map follows the dials of its object: at once where that is quick, so that the slider's undo step has both; else by
an operator that works in the background while the slider is free, whose undo step has the map and its dials."""

import time

import bpy
from bpy.props import StringProperty

from .. import native
from ..scene import stored_dials
from .mixins import TIMER_SECONDS, Explained, WorkOperator, redraw_sidebars

LIVE_SECONDS = 0.2  # up to which the last map of an object was made at once
LIVE_FACES = 600  # up to which the first one is
REST_SECONDS = 0.3  # during which no dial is changed before the work begins

_seconds = {}  # what the last map took, by the object's name


def changed(obj, context):
    """A dial of an object was changed."""
    if not follows(obj):
        return
    if bpy.app.background or context.window is None or _expected(obj) < LIVE_SECONDS:
        make(obj, context)
    else:
        getattr(obj, stored_dials.NAME).is_waiting = True
        _begin(obj.name, context.window)


def follows(obj):
    """Whether an object has a map of other dials, which can be made anew."""
    if obj is None or obj.type != "MESH" or obj.mode != "OBJECT" or obj.library is not None:
        return False
    made = stored_dials.made(obj)
    return made is not None and not made.is_selection and not made.scale_of and stored_dials.is_behind(obj)


def _expected(obj):
    return _seconds.get(obj.name, 0.0 if len(obj.data.polygons) <= LIVE_FACES else LIVE_SECONDS)


class _Making:
    """The map of the dials of an object, while it is made. @throws ValueError it cannot be"""

    def __init__(self, obj):
        from . import request

        dials = getattr(obj, stored_dials.NAME)
        self._name, self._is_shown = obj.name, dials.checker
        own, self._why_not_own = request.own_texture(dials)
        self._run = request.Run(dials, request.collect([obj], dials), own, goes_on=True)
        self.job = self._run.job()

    def write(self, context, time_has_passed):
        """Returns why the map is not that of the dials, or ""."""
        from ..materials import material
        from ..scene import gathering
        from ..writing import transaction

        self.job.wait()
        with transaction.one_step(context, self._run.objects) as step:
            outcome = self._run.write(step, self.job, time_has_passed)
            if outcome.done and not self._is_shown:
                obj = bpy.data.objects[self._name, None]
                for each in (obj, *gathering.others(obj)):
                    material.uncover(each)
        return self._why_not_own if outcome.done else "; ".join(outcome.problems)


def make(obj, context):
    """Makes the map of the dials here and now, or notes with the dials why not."""
    start, name = time.perf_counter(), obj.name
    try:
        making = _Making(obj)
        making.job.run()
        refused = making.write(context, time_has_passed=False)
    except ValueError as error:
        refused = native.sentence(error)
    _seconds[name] = time.perf_counter() - start
    _end(obj, context, refused)


def _end(obj, context, refused):
    """What is told with the dials, and in the redo panel, which goes on from them."""
    group = getattr(obj, stored_dials.NAME)
    group.refused, group.is_waiting = refused, False
    last = context.window_manager.operators[-1:] or ()
    if not stored_dials.is_behind(obj):
        for operator in (one for one in last if one.bl_idname.startswith("UV_OT_holomorphic_")):
            for name, value in stored_dials.of(obj).items():
                if name in operator.properties.bl_rna.properties:
                    setattr(operator.properties, name, value)
    redraw_sidebars(context)


def _begin(name, window):
    """Starts the operator, unless it runs: Blender is not to run one while it tells of a change."""

    def start():
        if HOLOMORPH_OT_follow.active is None and window in bpy.context.window_manager.windows[:]:
            with bpy.context.temp_override(window=window):
                bpy.ops.uv.holomorphic_follow("INVOKE_DEFAULT", True, name=name)

    bpy.app.timers.register(start, first_interval=0.0)


class HOLOMORPH_OT_follow(Explained, bpy.types.Operator):
    """Make the map of the dials that were changed"""

    bl_idname = "uv.holomorphic_follow"
    bl_label = "Update Map"
    bl_options = {"UNDO", "INTERNAL"}
    left_modes = frozenset()
    name: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    active = None  # the one that runs

    @classmethod
    def why_not(cls, _context):
        return ""

    def invoke(self, context, _event):
        self._making, self._wanted, self._since = None, None, 0.0
        self._timer = context.window_manager.event_timer_add(TIMER_SECONDS, window=context.window)
        HOLOMORPH_OT_follow.active = self.name
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        obj = bpy.data.objects.get((self.name, None))
        if not follows(obj):
            self.cancel(context)
            return {"CANCELLED", "PASS_THROUGH"}
        if self._is_stopped() or (event.type == "ESC" and event.value == "PRESS"):
            self.cancel(context)
            put_back(obj)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            return self._tick(obj, context)
        except ValueError as error:
            self.cancel(context)
            _end(obj, context, native.sentence(error))
            return {"CANCELLED"}
        except BaseException:
            self.cancel(context)
            raise

    def _tick(self, obj, context):
        now = stored_dials.of(obj)
        if now != self._wanted:
            self._stop()
            self._wanted, self._since = now, time.perf_counter()
        elif self._making is None and time.perf_counter() - self._since > REST_SECONDS:
            self._start = time.perf_counter()
            self._making = _Making(obj)
            WorkOperator.running = self._making.job
            self._making.job.start()
        elif self._making is not None and self._making.job.is_running():
            redraw_sidebars(context)
        elif self._making is not None:
            making, self._making = self._making, None
            _seconds[self.name] = time.perf_counter() - self._start
            self.cancel(context)
            _end(obj, context, making.write(context, time_has_passed=True))
            return {"FINISHED"}
        return {"PASS_THROUGH"}

    def _is_stopped(self):
        return self._making is not None and self._making.job.watch.is_cancelled

    def _stop(self):
        """Whatever is made is not waited for."""
        if self._making is not None:
            self._making.job.cancel()
        self._making, WorkOperator.running = None, None

    def cancel(self, context):
        self._stop()
        HOLOMORPH_OT_follow.active = None
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        redraw_sidebars(context)


def put_back(obj):
    """The dials are those of the map again."""
    made = stored_dials.made(obj)
    getattr(obj, stored_dials.NAME).is_waiting = False
    if made:
        stored_dials.write(obj, stored_dials.read(made.dials))


@bpy.app.handlers.persistent
def _agree(*_arguments):
    """After undo, redo and loading: between the step of a slider and that of its map the dials are those of the map."""
    for obj in bpy.data.objects:
        if obj.is_property_set(stored_dials.NAME) and getattr(obj, stored_dials.NAME).is_waiting:
            put_back(obj)


HANDLERS = bpy.app.handlers.undo_post, bpy.app.handlers.redo_post, bpy.app.handlers.load_post


def register():
    bpy.utils.register_class(HOLOMORPH_OT_follow)
    for handlers in HANDLERS:
        handlers.append(_agree)


def unregister():
    for handlers in HANDLERS:
        handlers.remove(_agree)
    bpy.utils.unregister_class(HOLOMORPH_OT_follow)
