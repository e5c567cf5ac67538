"""One set of values: the dials of an object, from which everything starts, and which a map follows."""

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from drawn_panel import Drawn
from headless_runs import pressed_here, sets
from loaded_addon import module
from scenes import everything, mesh_object, select, sphere_arrays, stored_report, torus, uv
from scenes import stored_poles as poles

stored_dials, follow, mapping, dials_view = (
    module(name) for name in ("scene.stored_dials", "operators.follow", "operators.mapping", "operators.dials_view")
)
DIALS = {
    "texture": "BRICKS",
    "checker": False,
    "tiles": 30,
    "size": 0.25,
    "evenness": 0.75,
    "turns": "NONE",
    "direction": "Z",
    "quarters": 1,
    "main": "SEAMLESS",
    "rotation": 0.5,
    "rows": "ANYWHERE",
    "boundary": "free",
    "poles": "COUNT",
    "repeats": 2,
    "seams": True,
}


@pytest.mark.parametrize("dial", DIALS)
def test_the_map_follows_and_is_that_of_the_button_and_of_a_script(dial):
    obj, other = torus(), torus("Other")
    select(obj)
    bpy.ops.uv.holomorphic_maps()
    setattr(obj.holomorph_map, dial, DIALS[dial])
    assert not obj.holomorph_map.refused and not stored_dials.is_behind(obj)
    followed, made_of = uv(obj), stored_dials.of(obj)
    assert stored_report(obj)["dials"]["stored"] == made_of and made_of[dial] == DIALS[dial]
    assert mapping.press(obj) == {"FINISHED"}
    assert np.array_equal(uv(obj), followed) and stored_dials.of(obj) == made_of
    select(other)
    bpy.ops.uv.holomorphic_maps(**{dial: DIALS[dial]})
    assert np.array_equal(uv(other), followed) and stored_dials.of(other) == made_of


def test_the_command_stores_what_it_is_asked_for(tmp_path):
    torus()
    source, target = tmp_path / "source.blend", tmp_path / "made.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(source))
    pressed_here("--output", target, *sets("tiles=30", "evenness=0.75", "texture=BRICKS"), blend=source)
    bpy.ops.wm.open_mainfile(filepath=str(target))
    obj = bpy.data.objects["Torus"]
    assert (obj.holomorph_map.tiles, obj.holomorph_map.texture) == (30, "BRICKS") and not stored_dials.is_behind(obj)
    made = uv(obj)
    mapping.press(obj)
    assert np.array_equal(uv(obj), made)


def test_a_script_starts_with_the_dials_of_the_object():
    """Beside those that it gives; a number of tiles takes the place of their size."""
    obj = torus()
    obj.holomorph_map.evenness, obj.holomorph_map.texture, obj.holomorph_map.size = 0.75, "BRICKS", 0.25
    bpy.ops.uv.holomorphic_tile(tiles=30, texture="SCALES")
    made = stored_report(obj)["dials"]["stored"]
    assert [made[name] for name in ("evenness", "texture", "size", "tiles")] == [0.75, "SCALES", 0, 30]
    bpy.ops.uv.holomorphic_maps(size=0.5)
    made = stored_report(obj)["dials"]["stored"]
    assert [made[name] for name in ("main", "texture", "size", "tiles")] == ["SEAMLESS", "SCALES", 0.5, 0]


def test_the_command_starts_with_the_dials_of_each_object(tmp_path):
    """Beside its options."""
    first, second, alike = (torus(name) for name in "ABC")
    first.holomorph_map.tiles, first.holomorph_map.evenness = 30, 0.75
    second.holomorph_map.texture = alike.holomorph_map.texture = "BRICKS"
    source, report = tmp_path / "source.blend", tmp_path / "report.json"
    bpy.ops.wm.save_as_mainfile(filepath=str(source))
    pressed_here(*sets("evenness=0.25"), "--report", report, blend=source)
    made = {one["object"]: one["dials"] for one in json.loads(report.read_text())["objects"]}
    asked = {name: [made[name]["stored"][dial] for dial in ("tiles", "evenness", "texture")] for name in "ABC"}
    assert asked == {"A": [30, 0.25, "CHECKER"], "B": [0, 0.25, "BRICKS"], "C": [0, 0.25, "BRICKS"]}
    assert [made[name]["together"] for name in "ABC"] == [1, 2, 2]


def test_an_object_without_a_map_only_keeps_its_dials():
    obj = torus()
    obj.holomorph_map.tiles = 30
    assert not obj.data.uv_layers and "holomorph_report" not in obj
    mapping.press(obj)
    assert stored_report(obj)["dials"]["stored"]["tiles"] == 30


def test_the_numbers_in_effect_are_shown_and_set():
    obj = mesh_object("Ball", *sphere_arrays(3))
    bpy.ops.uv.holomorphic_maps()
    dials, tiles, width = obj.holomorph_map, obj.holomorph_map.made.tiles, obj.holomorph_map.made.width
    assert dials.tiles == 0 and dials.tiles_shown == tiles > 0
    dials.by_size = True
    assert dials.size == pytest.approx(width) and dials.size_shown == dials.size
    dials.by_size = False
    dials.tiles_shown = 2 * tiles
    assert dials.tiles == dials.tiles_shown == 2 * tiles


def test_before_the_first_map_there_is_no_number_of_tiles_but_a_button():
    dials = torus().holomorph_map
    assert not dials.by_count
    dials.by_count = True
    assert dials.by_count and dials.tiles == dials.tiles_shown == 100
    dials.by_count = False
    assert not dials.by_count and dials.tiles == 0


def test_undo_takes_dial_and_map_back_together():
    torus()
    bpy.ops.uv.holomorphic_maps()
    bpy.ops.ed.undo_push(message="made")
    before = uv(bpy.data.objects["Torus"])
    bpy.data.objects["Torus"].holomorph_map.evenness = 1.0
    after = uv(bpy.data.objects["Torus"])
    bpy.ops.ed.undo_push(message="dial")
    assert not np.array_equal(before, after)
    for step, value, expected in ((bpy.ops.ed.undo, 0.5, before), (bpy.ops.ed.redo, 1.0, after)):
        step()
        obj = bpy.data.objects["Torus"]
        assert obj.holomorph_map.evenness == value and np.array_equal(uv(obj), expected)
        assert not stored_dials.is_behind(obj)


def test_after_the_step_of_a_slider_that_waited_the_dials_are_those_of_the_map():
    obj = torus()
    bpy.ops.uv.holomorphic_maps()
    with stored_dials.quietly():
        obj.holomorph_map.evenness = 1.0
    obj.holomorph_map.is_waiting = True
    follow._agree()
    assert obj.holomorph_map.evenness == 0.5 and not stored_dials.is_behind(obj)


def test_an_error_in_the_middle_leaves_the_map_and_says_that_the_dial_is_ahead(monkeypatch):
    obj = torus()
    bpy.ops.uv.holomorphic_maps()
    assert obj.holomorph_map.evenness == 0.5  # which adds the group to the object
    before, report = everything(obj), obj["holomorph_report"]

    def fail(*_arguments, **_options):
        raise ValueError("no room")

    monkeypatch.setattr(module("results.report"), "with_coarse_places", fail)
    obj.holomorph_map.evenness = 1.0
    assert everything(obj) == before and obj["holomorph_report"] == report
    assert obj.holomorph_map.refused == "no room" and obj.holomorph_map.evenness == 1.0 and stored_dials.is_behind(obj)
    monkeypatch.undo()
    obj.holomorph_map.evenness = 0.9
    assert not obj.holomorph_map.refused and not stored_dials.is_behind(obj)


def test_a_texture_that_is_not_chosen_is_asked_for():
    obj = torus()
    bpy.ops.uv.holomorphic_maps()
    obj.holomorph_map.texture = "IMAGE"
    assert obj.holomorph_map.refused == "Choose an image"


def test_the_eye_brings_the_objects_own_materials_back():
    obj = torus()
    obj.data.materials.append(bpy.data.materials.new("Mine"))
    bpy.ops.uv.holomorphic_maps()
    assert obj.material_slots[0].material.name != "Mine"
    for is_shown in (False, True):
        obj.holomorph_map.checker = is_shown
        assert (obj.material_slots[0].material.name == "Mine") != is_shown


def test_tiles_keep_the_size_that_they_have_on_other_objects():
    small, large = torus(), torus("Large")
    large.scale = (3, 3, 3)
    select(small, large)
    bpy.ops.uv.holomorphic_maps()
    before = small.holomorph_map.made.tiles
    small.holomorph_map.evenness = 0.6
    assert small.holomorph_map.made.tiles == pytest.approx(before, rel=0.2)


OTHERS = {"tiles": 30, "evenness": 0.75, "direction": "Z", "texture": "WEAVE", "quarters": 1, "seams": True}


def stars(obj):
    """{vertex: it and its neighbours}"""
    found = {vertex.index: {vertex.index} for vertex in obj.data.vertices}
    for one, other in (edge.vertices for edge in obj.data.edges):
        found[one].add(other)
        found[other].add(one)
    return found


def dragged(obj, neighbour=0, **options):
    """The neighbour, this one of those apart from other points, to which a point of a map is dragged."""
    bpy.ops.uv.holomorphic_maps(**options)
    (tiling,) = [part["tiling"] for part in stored_report(obj)["components"] if "tiling" in part]
    found, near = tiling["cones"] or tiling["poles"], stars(obj)

    def free(own):
        taken = set().union(*(near[vertex] for vertex in found if vertex != own))
        return sorted(vertex for vertex in near[own] - {own} if near[vertex].isdisjoint(taken))

    number = next(number for number, own in enumerate(found) if len(free(own)) > abs(neighbour))
    place = free(found[number])[neighbour]
    assert bpy.ops.uv.holomorphic_drag_poles(moves=f"{number}:{place}") == {"FINISHED"}
    return place


def points(obj):
    found = [part["tiling"] for part in stored_report(obj)["components"] if "tiling" in part]
    return {vertex for tiling in found for vertex in (*tiling["poles"], *tiling["cones"])}


# With 30 tiles fewer points are needed, and a choice of them would leave out that of some neighbour.
@pytest.mark.parametrize(("turns", "neighbour"), [("NONE", 0), ("NONE", 1), ("NONE", -1), ("QUARTER", 0)])
def test_a_point_stays_where_it_was_dragged_whatever_dial_is_turned(turns, neighbour, tmp_path):
    obj = mesh_object("Ball", *sphere_arrays(3))
    place = dragged(obj, neighbour, turns=turns)
    assert place in points(obj)
    for name, value in OTHERS.items():
        setattr(obj.holomorph_map, name, value)
        assert place in points(obj) and not obj.holomorph_map.refused, name
    obj.holomorph_map.turns = {"NONE": "HALF", "QUARTER": "NONE"}[turns]
    obj.holomorph_map.turns = turns
    assert place in points(obj)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    module("solving.jobs").KEPT.clear()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    obj = bpy.data.objects["Ball"]
    obj.holomorph_map.evenness = 0.25
    assert place in points(obj)
    bpy.ops.uv.holomorphic_automatic_points()
    assert obj.holomorph_map.moved == "" and not stored_dials.is_behind(obj)


def test_a_point_is_not_dragged_to_where_the_map_would_have_cuts():
    obj = mesh_object("Ball", *sphere_arrays(3))
    bpy.ops.uv.holomorphic_maps(turns="NONE")
    before, second = points(obj), poles(obj)[1]
    with pytest.raises(RuntimeError, match="take vertices farther apart"):
        bpy.ops.uv.holomorphic_drag_poles(moves=f"0:{min(stars(obj)[second] - before)}")
    assert obj.holomorph_map.moved == "" and points(obj) == before


def test_selected_points_stay_after_they_are_no_longer_selected():
    obj = torus()
    chosen = [5, 100, 200, 250]
    for vertex in obj.data.vertices:
        vertex.select = vertex.index in chosen
    bpy.ops.uv.holomorphic_tile(poles="SELECTED", turns="NONE")
    made = set(poles(obj))
    for vertex in obj.data.vertices:
        vertex.select = False
    obj.holomorph_map.evenness = 0.75
    assert set(poles(obj)) == made <= set(chosen) and made and obj.holomorph_map.poles == "AUTOMATIC"


@pytest.mark.parametrize("text", ["", "x", "[]", "{}", '{"vertices": 288}', json.dumps({"poles": [-1]})])
def test_damaged_points_are_none(text):
    obj = torus()
    obj.holomorph_map.moved = text
    assert mapping.press(obj) == {"FINISHED"}


def test_a_map_of_selected_faces_waits_for_the_button():
    obj = torus()
    for polygon in obj.data.polygons:
        polygon.select = polygon.index % 12 < 6
    bpy.ops.uv.holomorphic_maps(use_selection="FACES")
    before = uv(obj)
    obj.holomorph_map.evenness = 1.0
    assert np.array_equal(uv(obj), before) and stored_dials.is_behind(obj)


@pytest.mark.parametrize(
    ("tiles", "size", "row"),
    [(0, 0.0, ("tiles", "Automatic")), (9, 0.0, ("tiles", "")), (0, 0.5, ("size", ""))],
)
def test_the_redo_panel_says_where_the_tiles_are_automatic(tiles, size, row):
    layout = Drawn()
    dials_view.draw(layout, SimpleNamespace(texture="CHECKER", checker=True, tiles=tiles, size=size))
    rows = {name: text for name, text in layout.properties.items() if name in ("tiles", "size")}
    assert rows == dict([row])


def look(obj):
    """What the material of an object shows: its numbers and images."""
    nodes = obj.material_slots[0].material.node_tree.nodes
    return [(n.name, n.image if n.type == "TEX_IMAGE" else n.outputs[0].default_value) for n in nodes if has_value(n)]


def has_value(node):
    return node.type in ("TEX_IMAGE", "VALUE")


@pytest.mark.parametrize("texture", ["CHECKER", "BRICKS", "IMAGE"])
@pytest.mark.parametrize("main", ["SEAMLESS", "AUTOMATIC", "BALANCED"])
def test_a_dial_changes_the_object_that_has_it_and_no_other(texture, main):
    """Not through the material either, which they share until then, and again when both are mapped."""
    image = bpy.data.images.new("Wall", 8, 8)
    image.pack()
    options = {"texture": texture, "main": main, "size": 0.5} | ({"source": "Wall"} if texture == "IMAGE" else {})
    first, other, third = torus("First"), torus("Other"), torus("Third")
    select(first, other, third)
    assert bpy.ops.uv.holomorphic_maps(**options) == {"FINISHED"}
    shared, before, stays = first.material_slots[0].material, look(first), uv(other)
    assert other.material_slots[0].material == shared and look(other) == before
    first.holomorph_map.size = 0.25
    own = first.material_slots[0].material
    assert not first.holomorph_map.refused
    assert look(other) == before == look(third) and np.array_equal(uv(other), stays)
    first.holomorph_map.size = 0.125
    assert first.material_slots[0].material in (own, shared) and look(other) == before
    first.holomorph_map.size = 0.5
    assert look(first) == before == look(other)
    select(first, other, third)
    assert bpy.ops.uv.holomorphic_maps(**options | {"size": 0.3}) == {"FINISHED"}
    assert len({obj.material_slots[0].material for obj in (first, other, third)}) == 1
