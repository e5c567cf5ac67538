"""What objects store of their maps: reports are for readers, and nothing is lost with one."""

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
    uv,
)

stored_dials, report, bake, geometry, drag, follow, marks_view = map(
    module,
    (
        *("scene.stored_dials", "results.report", "baking.bake", "things.geometry"),
        *("operators.drag", "operators.follow", "overlays.marks_view"),
    ),
)
KEY = "holomorph_report"
DAMAGED = (
    None,
    "",
    "{",
    "[]",
    '{"components": [{"genus": 1}]}',
    5,
    0.5,
    [1, 2],
    {"a": 1},
    b"\xff",
)  # None: it is deleted


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
PRESSES = {
    "coarse": lambda: bpy.ops.uv.holomorphic_tile(poles="COARSE", is_trial=True),
    "drag": lambda: bpy.ops.uv.holomorphic_drag_poles(moves="0:5"),
    "symmetric": lambda: bpy.ops.uv.holomorphic_make_symmetric(),
    "own": lambda: bpy.ops.uv.holomorphic_tile(texture="IMAGE", source="Noise", turns="QUARTER"),
    "geometry": lambda: bpy.ops.object.holomorphic_geometry(),
    "levels": lambda: bpy.ops.object.holomorphic_levels(),
}


def damage(obj, value):
    if value is None:
        del obj[KEY]
    else:
        obj[KEY] = value


def known(obj):
    """What panels, overlays, polls and the beginnings of work read, for comparison."""
    layout, (points, kinds, _) = drawn(obj), marks_view._points(obj, None)
    _, corners, *lattice = geometry.source(obj)
    return {
        "made": stored_dials.known(obj),
        "panel": (layout.texts, layout.buttons, layout.icons),
        "dots": (points.tolist(), kinds.tolist()),
        "tiling": (corners.tolist(), lattice),
        "states": (report.is_edited(obj), stored_dials.is_behind(obj)),
        "polls": (drag.HOLOMORPH_OT_drag_poles.why_not(bpy.context), bake.why_not(obj)),
    }


def pressed(name):
    """What comes of it, in words."""
    try:
        return str(PRESSES[name]())
    except RuntimeError as error:
        return str(error)


@pytest.mark.parametrize("name", MADE)
def test_a_damaged_report_loses_nothing(name):
    obj = MADE[name]()
    before = known(obj)
    assert before["panel"][0] and before["made"]
    for value in DAMAGED:
        obj[KEY] = "{}"
        damage(obj, value)
        assert known(obj) == before, value


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("press", PRESSES)
def test_operators_go_on_without_a_report(name, press):
    results = []
    for is_damaged in (False, True):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        obj = MADE[name]()
        select(obj)
        if is_damaged:
            del obj[KEY]
        results.append((pressed(press), uv(obj).tolist(), stored_dials.known(obj)))
    assert results[0] == results[1] and "fault of Holomorph" not in results[0][0]


def test_a_map_follows_its_dials_without_a_report():
    obj = with_poles()
    del obj[KEY]
    obj.holomorph_map.evenness = 0.25
    assert KEY in obj and stored_report(obj)["dials"]["stored"]["evenness"] == 0.25


def test_what_is_known_is_that_of_the_report():
    obj = with_poles()
    entry, made = stored_report(obj), obj.holomorph_map.made
    (tiling,) = (part["tiling"] for part in entry["components"])
    vertices, kinds = report.points(obj)
    assert vertices[kinds == report.POLE].tolist() == tiling["poles"]
    assert vertices[kinds == report.ZERO].tolist() == tiling["zeros"]
    assert made.map == obj.data.uv_layers[0].name and made.cost == pytest.approx(entry["whole"]["cost"])
    assert stored_dials.read(made.dials) == entry["dials"]["stored"] == stored_dials.of(obj)


def test_it_is_saved_with_the_file_and_copied_with_the_object(tmp_path):
    obj = with_poles()
    before = stored_dials.known(obj)
    assert stored_dials.known(obj.copy()) == before
    path = str(tmp_path / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert stored_dials.known(bpy.data.objects["Torus"]) == before
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["Torus"]
    assert stored_dials.known(wanted.objects[0]) == before


def test_it_is_undone_with_the_map():
    obj = with_poles()
    before = stored_dials.known(obj)
    bpy.ops.ed.undo_push(message="before")
    run(main="BALANCED")
    assert stored_dials.known(obj) != before
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert stored_dials.known(bpy.data.objects["Torus"]) == before


def test_a_map_of_which_nothing_is_known_asks_for_the_button():
    """As in a file of the add-on before it stored this: a report alone is none."""
    obj = with_poles()
    obj.holomorph_map.property_unset("made")
    select(obj)
    assert stored_dials.made(obj) is None and stored_dials.known(obj) == () and not follow.follows(obj)
    assert not report.is_edited(obj) and not stored_dials.is_behind(obj) and not len(report.points(obj)[0])
    assert drag.HOLOMORPH_OT_drag_poles.why_not(bpy.context) == "Select an object whose map has points"
    assert "press Seamless Tiling first" in bake.why_not(obj)
    assert module("operators.mapping").press(obj) == {"FINISHED"} and stored_dials.made(obj)


def test_what_is_known_is_no_dial_and_has_all_dials():
    group = bpy.types.Object.bl_rna.properties[stored_dials.NAME].fixed_type
    made_of = group.properties["made"].fixed_type.properties["dials"].fixed_type.properties.keys()
    assert "made" not in stored_dials.names()
    assert {*made_of} - stored_dials.OF_BLENDER == {*stored_dials.names()} > {"tiles", "moved"}
