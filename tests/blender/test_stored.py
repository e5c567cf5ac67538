"""Stored reports that someone has damaged: valid JSON of another shape is no report, wherever one is read."""

import copy
import json
import random

import bpy
import numpy as np
import pytest
from drawn_images import periodic_noise
from drawn_panel import drawn
from loaded_addon import module
from scenes import (
    grid_arrays,
    mesh_object,
    run,
    select,
    sphere_arrays,
    stored_report,
    torus,
    tube_arrays,
    two_parts,
)

stored, symmetric, write, marks_view, bake, geometry, drag = map(
    module,
    (
        "results.stored",
        "results.symmetric",
        "results.write",
        "overlays.marks_view",
        "baking.bake",
        "things.geometry",
        "operators.drag",
    ),
)
KEY = "holomorph_report"
WRONG = (None, True, -1, 7, 10**12, 0.5, 1e300, float("nan"), "", "x", [], ["x"], [[]], [-1], {}, {"x": None})
OPERATORS_TRIED = 25  # mutations on which operators are pressed


def noise():
    made = bpy.data.images.new("Noise", 16, 16)
    pixels = np.dstack([0.5 + 0.2 * periodic_noise(16, 16, 1.5, seed) for seed in (1, 2, 3)] + [np.ones((16, 16))])
    module("scene.image_io").write_pixels(made, np.clip(pixels, 0, 1))
    made.pack()


def with_poles():
    obj = torus()
    bpy.ops.uv.holomorphic_tile(turns="NONE", poles="COUNT", pole_count=2)
    return obj


def own_on_turns():
    noise()
    obj = mesh_object("Ball", *sphere_arrays(3))
    bpy.ops.uv.holomorphic_tile(texture="IMAGE", source="Noise", turns="QUARTER")
    return obj


def coarse():
    vertices, faces = sphere_arrays(3)
    vertices = np.array(vertices)
    factor = 1 + 6 * np.exp(-24 * (0.5 - vertices.max(axis=1)))
    obj = mesh_object("Spikes", vertices * factor[:, None], faces)
    run(evenness=0.0)
    return obj


def of_parts():
    obj = two_parts("Pair", tube_arrays(), grid_arrays())
    run(main="AUTOMATIC")
    return obj


MADE = {"poles": with_poles, "own": own_on_turns, "coarse": coarse, "parts": of_parts}


def places(value, path=()):
    """The path of each value in a report, of lists only the first item's and that of a further one."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value[:1]) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


def mutations(entry):
    """The entry with each value replaced by each wrong one, or gone."""
    for path in filter(None, places(entry)):
        for wrong in (*WRONG, KEY):
            made = copy.deepcopy(entry)
            within = made
            for key in path[:-1]:
                within = within[key]
            if wrong == KEY:
                del within[path[-1]]
            else:
                within[path[-1]] = wrong
            yield json.dumps(made)
    yield from map(json.dumps, (*WRONG, [entry]))


def read_everywhere(obj):
    """What panels, overlays, polls and the beginnings of work read."""
    text = obj[KEY]
    drawn(obj, is_edited=stored.is_edited(stored.parsed(text), obj.data))
    stored.summary(text)
    stored.found(text)
    if stored.parsed(text):
        stored.is_behind(stored.parsed(text), obj)
    marks_view._points(obj, None)
    drag.HOLOMORPH_OT_drag_poles.why_not(bpy.context)
    symmetric.shown_turns(text)
    bake.why_not(obj)
    geometry.source(obj)
    if stored.parsed(text):
        write.options_of(stored.parsed(text)["dials"])


@pytest.mark.parametrize("name", MADE)
def test_a_report_that_was_made_is_read(name):
    obj = MADE[name]()
    assert stored.parsed(obj[KEY]) == stored_report(obj) and stored.summary(obj[KEY]) and drawn(obj).texts
    read_everywhere(obj)


@pytest.mark.parametrize("name", MADE)
def test_damaged_reports_are_read_as_none(name):
    obj = MADE[name]()
    for text in mutations(stored_report(obj)):
        obj[KEY] = text
        read_everywhere(obj)


@pytest.mark.parametrize("value", [5, 0.5, [1, 2], {"a": 1}, b"\xff", "[" * 100_000, '{"a": ' * 100_000])
def test_what_is_no_text_of_json_is_no_report(value):
    obj = with_poles()
    obj[KEY] = value
    read_everywhere(obj)
    assert stored.parsed(obj[KEY]) == {} and not drawn(obj).texts


PRESSES = {
    "coarse": lambda: bpy.ops.uv.holomorphic_tile(poles="COARSE", is_trial=True),
    "drag": lambda: bpy.ops.uv.holomorphic_drag_poles(moves="0:5"),
    "symmetric": lambda: bpy.ops.uv.holomorphic_make_symmetric(),
    "own": lambda: bpy.ops.uv.holomorphic_tile(texture="IMAGE", source="Noise", turns="QUARTER"),
    "geometry": lambda: bpy.ops.object.holomorphic_geometry(),
    "levels": lambda: bpy.ops.object.holomorphic_levels(),
}


@pytest.mark.parametrize("name", MADE)
def test_operators_on_damaged_reports_blame_nobody(name):
    """They work as without one, or say in one sentence what they need."""
    obj = MADE[name]()
    texts = list(mutations(stored_report(obj)))
    for text in random.Random(5).sample(texts, OPERATORS_TRIED):
        for press in PRESSES.values():
            select(obj)
            obj[KEY] = text
            try:
                press()
            except RuntimeError as error:
                assert "fault of Holomorph" not in str(error), text
