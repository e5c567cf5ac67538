"""The operator for seamless tilings: what it asks of the library, what it writes, reports and draws.

The library's part is played by `Stand`: integer combinations of the harmonic forms, seamless, but not conformal.
"""

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from conftest import module
from scenes import (
    everything,
    frame,
    mesh_io,
    native,
    pick,
    polygon_arrays,
    run,
    select,
    sphere_arrays,
    stored_report,
    torus,
    torus_arrays,
    two_parts,
    uv,
)

tiling, tile_report = module("tiling"), module("tile_report")


class Stand:
    """Notes the calls of `Structure.tile` and answers them, for closed parts with handles."""

    def __init__(self):
        self.calls = []

    def tile(self, structure, **asked):
        self.calls.append(asked)
        if asked["progress"] is not None and not asked["progress"](0.5, "tiling"):
            raise native.load().Cancelled("cancelled")
        if not hasattr(structure, "uv_of"):
            raise native.load().TopologyError("there is no handle")
        rank = 2 * structure.surface.genus
        turns = max(1, round((asked["tiles"] or 16) ** 0.5))
        n, m = turns * (np.arange(rank) % 2 == 0), turns * (np.arange(rank) % 2)
        values = structure.uv_of(n, m)
        quality = structure.quality(values)
        poles = asked["poles"] if isinstance(asked["poles"], list) else [0, 3]
        return SimpleNamespace(
            uv=values,
            periods=np.stack([n, m], 1),
            poles=np.array(poles),
            residues=np.ones(len(poles), complex),
            zeros=(np.array([1]), np.array([2])),
            added_distortion=1.002,
            left_over=1e-4,
            quality=quality,
            density_ratio=quality.density_ratio,
            seams=structure.edges[structure.seams],
        )


@pytest.fixture
def library(monkeypatch):
    stand = Stand()
    kind = native.load().results.Structure
    monkeypatch.setattr(kind, "tile", lambda structure, **asked: stand.tile(structure, **asked), raising=False)
    return stand


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**options)


def marks(obj):
    vertices, is_pole = tile_report.marks(obj["holomorph_report"])
    return vertices.tolist(), is_pole.tolist()


def jumps(obj):
    """Differences between the UVs of all corners of a vertex, each to the vertex's first."""
    corners, _ = polygon_arrays(obj.data)
    values = uv(obj)
    _, first, at = np.unique(corners, return_index=True, return_inverse=True)
    return values - values[first[at]]


def test_the_map_is_written_and_jumps_by_whole_numbers_exactly(library):
    obj = torus()
    obj.data.uv_layers.new(name="Artist")
    assert tile(tiles=50) == {"FINISHED"}
    assert [layer.name for layer in obj.data.uv_layers] == ["Artist", "Holomorphic"]
    assert obj.data.uv_layers.active.name == "Holomorphic"
    found = jumps(obj)
    assert np.array_equal(found, np.round(found)) and np.abs(found).max() == 7


def test_it_takes_the_place_of_earlier_maps(library):
    obj = frame()
    run()
    tile()
    assert [layer.name for layer in obj.data.uv_layers] == ["Holomorphic"]
    run()
    assert "tiling" not in stored_report(obj)["components"][0]


def test_what_is_asked_of_the_library(library):
    torus()
    tile()
    asked = library.calls[-1]
    assert asked.pop("progress") is not None
    assert asked == dict(tiles=None, poles="auto", lattice="square", direction=None, boundary="straight")
    tile(tiles=12, poles="COUNT", pole_count=3, lattice="hex", boundary="free")
    asked = library.calls[-1]
    assert asked.pop("progress") is not None
    assert asked == dict(tiles=12.0, poles=3, lattice="hex", direction=None, boundary="free")


def test_the_direction_is_the_objects_axis(library):
    obj = torus()
    obj.rotation_euler.y = np.pi / 2
    bpy.context.view_layer.update()
    tile(direction="Z")
    assert np.allclose(library.calls[-1]["direction"], (1, 0, 0), atol=1e-6)


def test_the_direction_of_selected_edges(library):
    obj = torus()
    pick(obj, [])
    with pytest.raises(RuntimeError, match="select edges"):
        tile(direction="EDGES")
    pick(obj, [0, 12])
    tile(direction="EDGES")
    vertices, _ = torus_arrays()
    edge = vertices[12] - vertices[0]
    asked = np.array(library.calls[-1]["direction"])
    assert np.allclose(np.abs(asked @ edge), np.linalg.norm(edge), rtol=1e-5)
    assert np.linalg.norm(asked) == pytest.approx(1)


def test_opposite_edges_have_one_direction():
    along = np.array([[1, 2, 0], [-1, -2, 0.1], [2, 4, -0.1]])
    found = module("tile_choices").mean_direction(along)
    assert np.allclose(found, np.array([1, 2, 0]) / 5**0.5, atol=0.05)


def test_selected_poles_go_to_their_parts(library):
    obj = two_parts("Two", torus_arrays(), torus_arrays())
    count = len(torus_arrays()[0])
    pick(obj, [])
    with pytest.raises(RuntimeError, match="select the vertices"):
        tile(poles="SELECTED")
    pick(obj, [count + 5, count + 20])
    tile(poles="SELECTED")
    assert [call["poles"] for call in library.calls] == ["auto", [5, 20]]
    bpy.ops.object.mode_set(mode="OBJECT")
    assert marks(obj) == ([0, 3, count + 5, count + 20, 1, count + 1], [True] * 4 + [False] * 2)


def test_parts_share_the_tiles_by_area_and_move_by_whole_units(library):
    vertices, faces = torus_arrays()
    obj = two_parts("Two", (vertices, faces), (2 * vertices, faces))
    tile(tiles=100)
    assert [call["tiles"] for call in library.calls] == pytest.approx([20, 80], rel=1e-5)
    found = jumps(obj)
    assert np.array_equal(found, np.round(found))
    halves = np.split(uv(obj), 2)
    boxes = [(np.floor(h.min(axis=0)), np.ceil(h.max(axis=0))) for h in halves]
    assert np.any(boxes[0][1] <= boxes[1][0]) or np.any(boxes[1][1] <= boxes[0][0])
    assert np.all(uv(obj).min(axis=0) >= 0) and np.all(uv(obj).min(axis=0) < 1)


def test_quarter_turns(library):
    obj = torus()
    tile()
    before = uv(obj)
    for quarters in range(4):
        tile(quarters=quarters)
        z = (before @ (1, 1j)) * 1j**quarters
        offset = uv(obj) @ (1, 1j) - z
        assert np.allclose(offset, np.round(offset[0]), atol=1e-5)
    assert len(library.calls) == 1


def test_only_what_changed_is_done_again(library, monkeypatch):
    torus()
    run()

    def forbidden(*_):
        raise AssertionError("solved again")

    monkeypatch.setattr(module("solve"), "solve", forbidden)
    for options, calls in (({}, 1), ({"texture": "SCALES"}, 1), ({"tiles": 40}, 2), ({"quarters": 1}, 2), ({}, 2)):
        assert tile(**options) == {"FINISHED"}
        assert len(library.calls) == calls


def test_few_tilings_are_kept(library):
    torus()
    for tiles in (*range(1, 8), 7, 1):
        tile(tiles=tiles)
    assert len(library.calls) == 8


def test_a_part_that_the_library_refuses_is_told(library):
    obj = two_parts("Mixed", torus_arrays(), sphere_arrays())
    assert tile() == {"FINISHED"}
    first, second = stored_report(obj)["components"]
    assert first["done"] and not second["done"] and second["reason"] == "there is no handle"
    assert len(marks(obj)[0]) == 3


def test_an_object_that_is_refused_stays_as_it_was(library):
    obj = two_parts("Spheres", sphere_arrays(), sphere_arrays())
    before = everything(obj)
    with pytest.raises(RuntimeError, match="part 1 of 2 skipped: there is no handle"):
        tile()
    assert everything(obj) == before


def test_report_and_panel_begin_with_words(library):
    obj = torus()
    tile()
    part = stored_report(obj)["components"][0]
    assert part["tiling"]["verdict"] == "Fairly even, seamless, 2 poles"
    assert part["tiling"]["residues"] == [[1, 0], [1, 0]] and part["tiling"]["orders"] == [2]
    lines = [line.strip() for line in module("report").summary(obj["holomorph_report"])]
    assert lines[:3] == ["1 map", "Part 1: genus 1", "Fairly even, seamless, 2 poles"]
    assert json.loads(bpy.data.texts["Holomorphic Report"].as_string())["objects"] == [stored_report(obj)]


@pytest.mark.parametrize(
    ("ratio", "added", "poles", "words"),
    [
        (5.9, 1.0, 8, "Even, seamless, 8 poles"),
        (19, 1.02, 0, "Fairly even, seamless, slightly sheared, no poles"),
        (3e4, 1.3, 1, "Uneven, seamless, sheared, 1 pole"),
    ],
)
def test_verdicts(ratio, added, poles, words):
    found = SimpleNamespace(density_ratio=ratio, added_distortion=added, poles=[0] * poles)
    assert tile_report.verdict(found) == words


@pytest.mark.parametrize("stored", ["", "{", "[]", "null", '{"components": []}', '{"components": [{"genus": 1}]}'])
def test_no_marks_without_a_tiling(stored):
    vertices, is_pole = tile_report.marks(stored)
    assert len(vertices) == len(is_pole) == 0


@pytest.mark.parametrize("mirrored", [False, True])
def test_empties_stand_at_the_poles_and_are_replaced(library, mirrored):
    obj = torus()
    obj.location, obj.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    obj.scale = (2, 2, -2 if mirrored else 2)
    tile(empties=True)
    for _ in range(2):
        assert tile(empties=True) == {"FINISHED"}
        bpy.context.view_layer.update()
        found = [o for o in bpy.data.objects if o.type == "EMPTY"]
        assert sorted(o.empty_display_type for o in found) == ["PLAIN_AXES", "SPHERE", "SPHERE"]
        assert all(o.parent == obj for o in found)
        at = np.array([o.matrix_world.translation for o in found])
        assert np.allclose(np.sort(at, axis=0), np.sort(mesh_io.world_points(obj, [0, 3, 1]), axis=0), atol=1e-5)
    tile()
    assert not [o for o in bpy.data.objects if o.type == "EMPTY"]


def test_textures_are_repeated_in_each_tile(library):
    obj = torus()
    tile(tiles=9, texture="BRICKS", repeats=3)
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert nodes["Repeats"].outputs[0].default_value == 3
    area = stored_report(obj)["components"][0]
    assert area["done"] and 0 < nodes["Relief"].outputs[0].default_value < 0.1
    tile(texture="CHECKER", repeats=2)
    nodes = obj.material_slots[0].material.node_tree.nodes
    assert nodes["Checker Scale"].outputs[0].default_value == 8


def test_seams_are_marked_where_the_map_jumps(library):
    obj = torus()
    tile(seams=True)
    seams = mesh_io.read_seams(obj.data)
    assert stored_report(obj)["seams_added"] == seams.sum() > 0
    vertices = {int(v) for edge in mesh_io.marked_edges(obj.data, "use_seam") for v in edge}
    jumping = np.unique(polygon_arrays(obj.data)[0][np.any(jumps(obj) != 0, axis=1)])
    assert set(jumping.tolist()) <= vertices


def test_undo_takes_everything_back(library):
    torus()
    bpy.ops.ed.undo_push(message="before")
    tile(empties=True)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Torus"]
    assert not obj.data.uv_layers and not obj.material_slots and "holomorph_report" not in obj
    assert len(bpy.data.objects) == 1


def test_edit_mode_and_several_objects(library):
    first, second = torus("First"), torus("Second")
    select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    assert tile() == {"FINISHED"}
    assert first.mode == second.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert all([layer.name for layer in o.data.uv_layers] == ["Holomorphic"] for o in (first, second))


def test_cancelling_leaves_no_result(library):
    torus()
    targets = module("targets")
    found = targets.collect(targets.mesh_objects(bpy.context))
    work = tiling.TileWork(targets.tasks(found) * 2, [tiling.TileOptions()] * 2)
    work._progress = lambda fraction, stage: work.cancel() if stage == "tiling" else None
    work.run()
    assert isinstance(work.results[0], native.load().Cancelled) and work.results[1] is None
    assert len(library.calls) == 1


@pytest.mark.parametrize("size", [0.7, 1, 13, 5000])
def test_whole_differences_survive_single_precision(size):
    rng = np.random.default_rng(1)
    base = rng.random((10000, 2))
    whole = rng.integers(-int(size), int(size) + 1, (10000, 2))
    both = tiling.on_grid(np.concatenate([base, base + whole]))
    assert both.dtype == np.float32
    first, second = np.split(both.astype(np.float64), 2)
    assert np.array_equal(second - first, whole)
    assert np.abs(first - base).max() <= 2**-24 * max(2 * size + 2, 2)


def test_discs_face_the_viewer_and_keep_their_size_on_the_screen():
    view = module("marks_view")
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
