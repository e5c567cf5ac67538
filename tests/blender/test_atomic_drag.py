"""Dragging poles writes all or nothing: with an error at any line that runs from the press of the button on, the file
is as before, and nothing is left of the dragging: no timer, no text, no marks over the view.
"""

from functools import partial
from types import FunctionType, SimpleNamespace

import bpy
import pytest
from injection import ERRORS, Lines, check
from loaded_addon import module
from scenes import mesh_io, select, stored_poles, two_objects

drag = module("operators.drag")
PLACE = 7  # vertex that the first pole is dragged to
HERE, ELSEWHERE = (10.0, 10.0), (1000.0, 1000.0)  # on the screen

# The operator's methods: Blender alone makes instances of it.
Hand = type(
    "Hand",
    (module("operators.mixins").Explained,),
    {name: method for name, method in vars(drag.HOLOMORPH_OT_drag_poles).items() if isinstance(method, FunctionType)},
)
told = []  # errors, which Blender raises when the operator has ended
Hand.report = lambda self, kinds, text: told.append(text) if "ERROR" in kinds else None


class Window:
    """What the operator uses of the context, where there is no window."""

    def __init__(self):
        self.timers, self.text, self.window = [], None, None
        self.area = SimpleNamespace(type="VIEW_3D", tag_redraw=lambda: None)
        self.window_manager = self.workspace = self
        self.active_object = bpy.context.active_object

    def __getattr__(self, name):
        return getattr(bpy.context, name)

    def event_timer_add(self, _seconds, window):
        self.timers.append("timer")
        return "timer"

    def event_timer_remove(self, _timer):
        self.timers.clear()  # one that is gone is no error in Blender

    def modal_handler_add(self, _operator):
        pass

    def status_text_set(self, text):
        self.text = text


class View:
    """The pointer is on the first pole, and in front of the vertex to which it is dragged."""

    def __init__(self, _area):
        obj = bpy.context.active_object
        self._pole = mesh_io.world_points(obj)[stored_poles(obj)[0]]
        self._vertex = obj.data.vertices[PLACE]

    def contains(self, x, y):
        return True

    def on_screen(self, point):
        return HERE if (point == self._pole).all() else ELSEWHERE

    def ray(self, x, y):
        return self._vertex.co + 0.1 * self._vertex.normal, -self._vertex.normal


@pytest.fixture
def window(monkeypatch):
    """A list of the latest `Window`."""
    monkeypatch.setattr(module("operators.surface_pick"), "View", View)
    return []


def dragged(window, key):
    """What the operator returns where the pole is dragged, the texture follows, and `key` ends it."""
    window[:] = [Window()]
    told.clear()
    context, hand = window[0], Hand()

    def event(kind, value="PRESS"):
        result = hand.modal(context, SimpleNamespace(type=kind, value=value, mouse_x=HERE[0], mouse_y=HERE[1]))
        if told:
            raise RuntimeError(told[0])
        return result

    if hand.invoke(context, None) != {"RUNNING_MODAL"}:
        raise RuntimeError("refused")  # as Blender does
    for kind in ("MOUSEMOVE", "LEFTMOUSE", "MOUSEMOVE", "TIMER"):
        assert event(kind) == {"RUNNING_MODAL"}
    hand._job._future.exception()  # no line of the add-on, in which an error could be raised
    event("TIMER")
    event("LEFTMOUSE", "RELEASE")
    return event(key)


@pytest.mark.usefixtures("kept_solves")
def test_drag_by_hand(window):
    """Given up first, then kept."""
    torus, _ = two_objects()
    select(torus)
    bpy.ops.uv.holomorphic_tile(tiles=20, empties=True, seams=True, pole_count=2, poles="COUNT")

    def press():
        assert dragged(window, "ESC") == {"CANCELLED"}
        return dragged(window, "RET")

    def nothing_is_left():
        assert (window[0].timers, window[0].text, module("overlays.overlay").dragged) == ([], None, {})

    # Neither the guards nor what calls them: an error there is none of the operator's.
    lines = partial(Lines, begin="invoke", guards=("modal", "_giving_up", "call", "event", "dragged"))
    check(press, lines, raises=ERRORS, then=nothing_is_left)
