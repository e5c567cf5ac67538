"""The operator for seamless tilings: what it asks of the library, what it writes, reports and draws.

All of it with the real library.
"""

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    edge_jumps,
    everything,
    frame,
    limb_arrays,
    mesh_io,
    mesh_object,
    native,
    next_corner,
    pick,
    polygon_arrays,
    run,
    select,
    sphere_arrays,
    stored_poles,
    stored_report,
    then,
    torus,
    torus_arrays,
    two_parts,
    uv,
    written,
)

report = module("results.report")


@pytest.fixture
def calls(monkeypatch):
    """What the library was asked for, one entry for each part of a map that is made."""
    search, noted = native.load().maps.map, []
    made = search.map_objects

    def noting(objects, size, **options):
        for request, surface, _ in (part for parts in objects for part in parts):
            noted.append({**vars(request), "tiles": size[0] * surface.area})
        return made(objects, size, **options)

    monkeypatch.setattr(search, "map_objects", noting)
    return noted


@pytest.fixture
def rounded(monkeypatch):
    """One entry for each map for which whole numbers were looked for."""
    search, noted = native.load().maps.map, []
    made = search.map_objects

    def noting(objects, size, progress):
        stages = set()

        def told(fraction, stage):
            stages.add(stage)
            return progress is None or progress(fraction, stage)

        found = made(objects, size, progress=told)
        noted.extend(["rounded"] * ("rounding" in stages))
        return found

    monkeypatch.setattr(search, "map_objects", noting)
    return noted


def tile(**options):
    """Shifted alone, with poles: test_turns.py has maps that turn."""
    return bpy.ops.uv.holomorphic_tile(**({"turns": "NONE"} | options))


def marks(obj):
    vertices, kinds = report.points(obj)
    return vertices.tolist(), (kinds == report.POLE).tolist()


def whole_jumps(obj):
    """Those of the UVs across each edge, at the ends that are not poles."""
    vertices, jumps = edge_jumps(obj)
    return jumps[~np.isin(vertices, stored_poles(obj))]


@pytest.mark.parametrize("options", [{}, {"tiles": 200}, {"poles": "COUNT", "pole_count": 0}, {"rotation": 0.5}])
def test_the_map_is_written_and_jumps_by_whole_numbers_exactly(options):
    obj = torus()
    obj.data.uv_layers.new(name="Artist")
    assert tile(**options) == {"FINISHED"}
    assert [layer.name for layer in obj.data.uv_layers] == ["Artist", "Holomorphic"]
    assert obj.data.uv_layers.active.name == "Holomorphic"
    found = whole_jumps(obj)
    assert np.array_equal(found, np.round(found)) and np.abs(found).max() >= 1


def test_it_takes_the_place_of_earlier_maps(calls):
    obj = frame()
    run()
    tile()
    assert [layer.name for layer in obj.data.uv_layers] == ["Holomorphic"]
    run()
    assert "tiling" not in stored_report(obj)["components"][0]


def test_what_is_asked_of_the_library(calls):
    torus()
    tile()
    plain = dict(poles="auto", lattice="square", direction="upright", turn=None, boundary="automatic", allowed=None)
    assert calls[0] == calls[0] | plain | dict(evenness=0.5, turns=1, tiles=pytest.approx(100))
    tile(tiles=120, poles="COUNT", pole_count=3, lattice="hex", boundary="free", rotation=0.25, direction="NONE")
    chosen = dict(poles=3, lattice="hex", boundary="free", turn=0.25, direction=None, tiles=pytest.approx(120))
    assert calls[1] == calls[1] | chosen


def risen(obj):
    """(#C, 2) along each edge: how far it rises in space, times u's and v's shares of its length in the plane."""
    corners, offsets = polygon_arrays(obj.data)
    following, heights = next_corner(offsets), mesh_io.world_points(obj)[:, 2]
    steps = uv(obj)[following] - uv(obj)
    rise = heights[corners[following]] - heights[corners]
    return steps / np.linalg.norm(steps, axis=1, keepdims=True) * rise[:, None]


@pytest.mark.parametrize("lattice", ["square", "brick", "hex"])
def test_the_texture_is_upright(lattice):
    obj = mesh_object("Limb", *limb_arrays())
    tile(lattice=lattice)
    across, along = (risen(obj) ** 2).sum(axis=0)
    assert along > 3 * across and risen(obj)[:, 1].sum() > 0


@pytest.mark.parametrize("turn", [0, np.pi])
def test_the_texture_of_a_tube_is_upright(turn):
    """Its rows lie along the rims in any case; they might be upside down."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type="NOTHING", rotation=(turn, 0, 0))
    obj = bpy.context.object
    tile()
    across, along = risen(obj).T
    assert np.abs(across).max() < 1e-3 and along.min() > -1e-3 and along.max() > 0.9


def test_quarter_turns_of_other_lattices_keep_the_texture_whole():
    """Once the map was turned after its jumps were rounded, and bricks broke off at the cut."""
    obj = torus()
    for quarters in range(4):
        tile(lattice="brick", quarters=quarters)
        rows = whole_jumps(obj)[..., 1]
        shifts = whole_jumps(obj)[..., 0] - rows / 2
        assert np.array_equal(rows, np.round(rows)) and np.array_equal(shifts, np.round(shifts))


def test_the_direction_is_the_objects_axis(calls):
    obj = torus()
    obj.rotation_euler.y = np.pi / 2
    bpy.context.view_layer.update()
    tile(direction="Z")
    assert np.allclose(calls[-1]["direction"], (1, 0, 0), atol=1e-6)


def test_the_direction_of_selected_edges(calls):
    obj = torus()
    pick(obj, [])
    with pytest.raises(RuntimeError, match="select the edges"):
        tile(direction="EDGES")
    pick(obj, [0, 12])
    tile(direction="EDGES")
    vertices, _ = torus_arrays()
    edge = vertices[12] - vertices[0]
    asked = np.array(calls[-1]["direction"])
    assert np.allclose(np.abs(asked @ edge), np.linalg.norm(edge), rtol=1e-5)
    assert np.linalg.norm(asked) == pytest.approx(1)


def test_a_direction_without_length_is_refused():
    obj = torus()
    obj.scale = (1, 1, 0)
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="Torus: its Z axis is scaled to 0"):
        tile(direction="Z")


def test_opposite_edges_have_one_direction():
    along = np.array([[1, 2, 0], [-1, -2, 0.1], [2, 4, -0.1]])
    found = module("operators.request").mean_direction(along)
    assert np.allclose(found, np.array([1, 2, 0]) / 5**0.5, atol=0.05)


def test_selected_poles_go_to_their_parts(calls):
    obj = two_parts("Two", torus_arrays(), torus_arrays())
    count = len(torus_arrays()[0])
    pick(obj, [])
    with pytest.raises(RuntimeError, match="select the vertices"):
        tile(poles="SELECTED")
    pick(obj, [count + 5, count + 155])
    tile(poles="SELECTED")
    assert sorted((call["poles"] for call in calls), key=str) == [[5, 155], "auto"]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [vertex for vertex in stored_poles(obj) if vertex >= count] == [count + 5, count + 155]


def painted(obj, vertices):
    """A vertex group in which these may be poles, and the others hardly."""
    group = obj.vertex_groups.new(name="Hidden")
    group.add(range(len(obj.data.vertices)), 0.4, "REPLACE")
    group.add(list(vertices), 0.6, "REPLACE")


def test_the_vertex_group_says_where_poles_may_be(calls):
    """And a part of which nothing is in the group gets none."""
    count, allowed = len(torus_arrays()[0]), []
    obj = two_parts("Two", torus_arrays(), torus_arrays())
    painted(obj, range(count // 2))

    tile(pole_group="Hidden")
    for asked in calls:
        allowed.append(
            (asked["poles"], None if asked["allowed"] is None else np.flatnonzero(asked["allowed"]).tolist())
        )
    assert sorted(allowed, key=str) == [("auto", list(range(count // 2))), (0, None)]
    assert all(vertex < count // 2 for vertex in stored_poles(obj))


@pytest.mark.parametrize(("group", "word"), [("Nothing", "no vertex group 'Nothing'"), ("Hidden", "above 0.5")])
def test_a_vertex_group_that_is_none_is_told(group, word):
    obj = torus()
    painted(obj, [])
    before = everything(obj)
    with pytest.raises(RuntimeError, match=word):
        tile(pole_group=group)
    assert everything(obj) == before


def test_parts_share_the_tiles_by_area_and_move_by_whole_units():
    vertices, faces = torus_arrays()
    obj = two_parts("Two", (vertices, faces), (2 * vertices, faces))
    tile(tiles=500)
    made = [part["tiling"]["tiles"] for part in stored_report(obj)["components"]]
    assert sorted(made) == pytest.approx([100, 400], rel=0.1)
    found = whole_jumps(obj)
    assert np.array_equal(found, np.round(found))
    halves = np.split(uv(obj), 2)
    boxes = [(np.floor(h.min(axis=0)), np.ceil(h.max(axis=0))) for h in halves]
    assert np.any(boxes[0][1] <= boxes[1][0]) or np.any(boxes[1][1] <= boxes[0][0])
    assert np.all(uv(obj).min(axis=0) >= 0) and np.all(uv(obj).min(axis=0) < 1)


def test_quarter_turns(calls):
    obj = torus()
    tile()
    before = uv(obj)
    for quarters in range(4):
        tile(quarters=quarters)
        z = (before @ (1, 1j)) * 1j**quarters
        offset = uv(obj) @ (1, 1j) - z
        assert np.allclose(offset, np.round(offset[0]), atol=1e-5)
    assert len(calls) == 1


def test_only_what_changed_is_done_again(rounded, monkeypatch):
    torus()
    run()

    def forbidden(*_):
        raise AssertionError("solved again")

    monkeypatch.setattr(module("solving.jobs"), "solved_anew", forbidden)
    for options, count in (({}, 1), ({"texture": "SCALES"}, 1), ({"tiles": 400}, 2), ({"quarters": 1}, 2), ({}, 2)):
        assert tile(**options) == {"FINISHED"}
        assert len(rounded) == count


def test_few_tilings_are_kept(calls):
    torus()
    counts = []
    for tiles in (*range(100, 107), 106, 100):
        tile(tiles=tiles)
        counts.append(len(calls))
    assert counts[-3] == counts[-2] < counts[-1]


def test_a_part_that_the_library_refuses_is_told(calls):
    obj = two_parts("Mixed", torus_arrays(), sphere_arrays())
    assert tile(poles="COUNT", pole_count=16) == {"FINISHED"}
    first, second = stored_report(obj)["components"]
    assert first["done"] and first["tiling"] and second["done"] and "tiling" not in second
    assert "has no tiling" in second["main_map"]["why"]
    assert max(marks(obj)[0]) < len(torus_arrays()[0])


def test_what_no_tiling_fits_gets_another_map():
    """A cube has no room for poles: it gets the six squares of its net, and no face is left without a map."""
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    assert tile() == {"FINISHED"}
    (part,) = stored_report(obj)["components"]
    assert part["main_map"]["kind"] == "islands" and part["main_map"]["size_range"] == pytest.approx(1)


def test_an_object_that_is_refused_stays_as_it_was(calls):
    obj = two_parts("Spheres", sphere_arrays(), sphere_arrays())
    before = everything(obj)
    with pytest.raises(RuntimeError, match="parts 1, 2 of 2 skipped: there is room for . of 16 poles"):
        tile(poles="COUNT", pole_count=16)
    assert everything(obj) == before


def test_report_and_panel_begin_with_words(calls):
    obj = torus()
    tile()
    part = stored_report(obj)["components"][0]
    verdict, residues = part["main_map"]["verdict"]["sentence"], np.array(part["tiling"]["residues"])
    assert ", seamless" in verdict and f"{len(residues)} poles" in verdict
    assert np.array_equal(residues, np.round(residues)) and np.array_equal(residues.sum(axis=0), (0, 0))
    assert min(part["tiling"]["orders"]) > 0
    lines = [line.strip() for line in obj.holomorph_map.made.summary.splitlines()]
    assert lines[:3] == ["1 map", "Part 1: genus 1", verdict]
    assert json.loads(bpy.data.texts["Holomorphic Report"].as_string())["objects"] == [stored_report(obj)]


def test_the_number_of_tiles_that_was_chosen_is_told(calls):
    obj = torus()
    outcome = written(obj, main="SEAMLESS")
    (tiling,) = [part["tiling"] for part in outcome.entries[0]["components"]]
    assert outcome.tiles == round(tiling["tiles"]) > 0
    assert written(obj, main="BALANCED").tiles == 0


def test_no_marks_without_a_tiling():
    obj = torus()
    assert marks(obj) == ([], [])
    run()
    assert obj.holomorph_map.made.map and marks(obj) == ([], [])


@pytest.mark.parametrize("mirrored", [False, True])
def test_empties_stand_at_the_poles_and_are_replaced(mirrored):
    obj = torus()
    obj.location, obj.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    obj.scale = (2, 2, -2 if mirrored else 2)
    tile(empties=True)
    for _ in range(2):
        assert tile(empties=True) == {"FINISHED"}
        bpy.context.view_layer.update()
        found = [o for o in bpy.data.objects if o.type == "EMPTY"]
        vertices, is_pole = marks(obj)
        assert sum(o.empty_display_type == "SPHERE" for o in found) == sum(is_pole) > 0
        assert sum(o.empty_display_type == "PLAIN_AXES" for o in found) == len(is_pole) - sum(is_pole) > 0
        assert all(o.parent == obj for o in found)
        at = np.array([o.matrix_world.translation for o in found])
        assert np.allclose(np.sort(at, axis=0), np.sort(mesh_io.world_points(obj, vertices), axis=0), atol=1e-5)
    tile(empties=False)
    assert not [o for o in bpy.data.objects if o.type == "EMPTY"]


def test_textures_are_repeated_in_each_tile(calls):
    obj = torus()
    tile(texture="BRICKS", repeats=3)
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert nodes["Repeats"].outputs[0].default_value == 3
    area = stored_report(obj)["components"][0]
    assert area["done"] and 0 < nodes["Relief"].outputs[0].default_value < 0.1
    tile(texture="CHECKER", repeats=2)
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert nodes["Checker Scale"].outputs[0].default_value == 8


def test_seams_are_marked_where_the_map_jumps(calls):
    obj = torus()
    tile(seams=True)
    seams = mesh_io.read_seams(obj.data)
    assert stored_report(obj)["seams_added"] == seams.sum() > 0
    vertices = {int(v) for edge in mesh_io.marked_edges(obj.data, "use_seam") for v in edge}
    pairs, jumps = edge_jumps(obj)
    jumping = np.unique(pairs[np.any(jumps != 0, axis=(1, 2))])
    assert set(jumping.tolist()) <= vertices


def test_undo_takes_everything_back(calls):
    torus()
    bpy.ops.ed.undo_push(message="before")
    tile(empties=True)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Torus"]
    assert not obj.data.uv_layers and not obj.material_slots and "holomorph_report" not in obj
    assert len(bpy.data.objects) == 1


def test_edit_mode_and_several_objects(calls):
    first, second = torus("First"), torus("Second")
    select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    assert tile() == {"FINISHED"}
    assert first.mode == second.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert all([layer.name for layer in o.data.uv_layers] == ["Holomorphic"] for o in (first, second))


def test_cancelling_leaves_no_result():
    torus()
    targets, jobs = module("scene.targets"), module("solving.jobs")
    tasks = targets.tasks(targets.collect(module("scene.gathering").mesh_objects(bpy.context))) * 2
    made = then(2, main="SEAMLESS")
    work = jobs.Job(tasks, lambda fraction: work.cancel() if fraction > 0.2 else None, made)
    work.run()
    assert all(isinstance(found, native.load().Cancelled) for found in work.results)


def test_the_same_bits_twice():
    obj = torus()
    tile()
    before = uv(obj)
    module("solving.jobs").KEPT.clear()
    tile()
    assert np.array_equal(uv(obj), before)


def test_discs_face_the_viewer_and_keep_their_size_on_the_screen():
    view = module("overlays.marks_view")
    points = np.array([(0.0, 0, -2), (0.5, 0.2, -20)])
    window = np.diag([1.5, 2.0, -1.0, 0.0])
    window[2, 3], window[3, 2] = -0.2, -1.0
    perspective = SimpleNamespace(perspective_matrix=window, window_matrix=window)
    sizes = view.pixel_sizes(points, perspective, 400)
    found = view.discs(points, 10 * sizes, np.eye(3)[:2]).reshape(2, -1, 3)
    for middle, disc in zip(points, found):
        on_screen = 200 * 2.0 * disc[:, 1] / -disc[:, 2]
        assert np.ptp(on_screen) == pytest.approx(20, rel=1e-5)
        assert np.allclose(disc[:, 2], middle[2]) and np.allclose(disc[::3], middle)
    window = np.diag([0.1, 0.2, 1.0, 1.0])
    orthographic = SimpleNamespace(perspective_matrix=window, window_matrix=window)
    assert np.allclose(view.pixel_sizes(points, orthographic, 400), 2 / (400 * 0.2))


def test_the_operator_says_what_it_needs():
    with pytest.raises(RuntimeError, match="Select a mesh"):
        tile()
