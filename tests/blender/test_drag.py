"""Poles that are dragged, by the operator as scripts call it, and what of a mesh is under the pointer."""

import json
from functools import partial
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from loaded_addon import module
from mathutils import Matrix, Vector
from scenes import (
    edge_jumps,
    everything,
    mesh_io,
    mesh_object,
    native,
    select,
    sphere_arrays,
    stored_report,
    torus,
    torus_arrays,
    two_parts,
    uv,
)
from scenes import (
    stored_poles as poles,
)

drag = module("operators.drag")


def tile(**options):
    """Shifted alone, with poles: test_turns.py has maps that turn."""
    return bpy.ops.uv.holomorphic_tile(**({"turns": "NONE"} | options))


def move(moves):
    return bpy.ops.uv.holomorphic_drag_poles(moves=moves)


def neighbour(obj, vertex, steps=1):
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    for _ in range(steps):
        vertex = max(edge.other_vert(bm.verts[vertex]).index for edge in bm.verts[vertex].link_edges)
    bm.free()
    return vertex


@pytest.fixture
def stages(monkeypatch):
    """The stages that the library went through."""
    search, noted = native.load().maps.map, []
    made = search.map_objects

    def noting(objects, size, progress):
        def told(fraction, stage):
            noted.append(stage)
            return progress is None or progress(fraction, stage)

        return made(objects, size, progress=told)

    monkeypatch.setattr(search, "map_objects", noting)
    return noted


def test_other_tiles_rotations_and_lattices_place_no_poles_again(stages):
    torus()
    tile()
    assert {"search for poles", "rounding"} <= set(stages)
    for options in ({"lattice": "hex"}, {"lattice": "square"}, {"tiles": 150}, {"rotation": 0.3}, {"quarters": 1}):
        stages.clear()
        assert tile(**options) == {"FINISHED"}
        assert "search for poles" not in stages
    assert stages == []
    bpy.context.active_object.data.vertices[0].co.x += 0.01
    tile()
    assert "search for poles" in stages


def test_tilers_count_in_the_size_of_what_is_kept(monkeypatch):
    kept = module("solving.jobs").KEPT
    first, second = torus("First"), torus("Second", thickness=0.5)
    for obj in (first, second):
        select(obj)
        tile()
    solved = list(kept.values())
    assert len(solved) == 2 and all(s.nbytes > 8 * 40 * len(s.done[0].structure.edges) for s in solved)
    monkeypatch.setattr(kept, "limit", solved[1].nbytes)
    tile(tiles=150)
    assert list(kept.values()) == solved[1:]


def test_a_pole_goes_where_it_is_put_and_the_map_stays_seamless(stages):
    obj = torus()
    tile(empties=True)
    before, place = poles(obj), neighbour(obj, poles(obj)[1])
    stages.clear()
    assert move(f"1:{place}") == {"FINISHED"}
    assert not {"rounding", "search for poles"} & set(stages)
    assert poles(obj)[1] == place != before[1]
    vertices, jumps = edge_jumps(obj)
    jumps = jumps[~np.isin(vertices, poles(obj))]
    assert np.array_equal(jumps, np.round(jumps)) and np.abs(jumps).max() >= 1
    assert json.loads(obj.holomorph_map.moved)["moves"] == [[1, place]]
    assert stored_report(obj)["components"][0]["tiling"]["added_distortion"] < 1.05
    bpy.context.view_layer.update()
    at = [
        o.matrix_world.translation for o in bpy.data.objects if o.empty_display_type == "SPHERE" and o.type == "EMPTY"
    ]
    assert min((Vector(mesh_io.world_points(obj)[place]) - place_of).length for place_of in at) < 1e-5


def test_a_second_move_adds_to_the_first_and_tiles_can_change_with_the_poles_kept(stages):
    obj = torus()
    tile(poles="COUNT", pole_count=4)
    first = neighbour(obj, poles(obj)[0])
    move(f"0:{first}")
    second = neighbour(obj, poles(obj)[2])
    move(f"2:{second}")
    assert (poles(obj)[0], poles(obj)[2]) == (first, second)
    assert sorted(json.loads(obj.holomorph_map.moved)["moves"]) == [[0, first], [2, second]]
    kept = poles(obj)
    tile(poles="COUNT", pole_count=4, tiles=150)
    assert sorted(poles(obj)) == sorted(kept)


def test_the_same_after_everything_was_forgotten():
    obj = torus()
    tile(tiles=120, rotation=0.2)
    move(f"0:{neighbour(obj, poles(obj)[0])}")
    before = uv(obj)
    place = poles(obj)[0]
    module("solving.jobs").KEPT.clear()
    move(f"0:{place}")
    assert np.array_equal(uv(obj), before)


def test_moves_of_several_parts():
    obj = two_parts("Two", torus_arrays(), sphere_arrays(3))
    tile(poles="COUNT", pole_count=2)
    found = poles(obj)
    count = len(torus_arrays()[0])
    pole = next(i for i, vertex in enumerate(found) if vertex >= count)
    place = neighbour(obj, found[pole])
    assert move(f"{pole}:{place}") == {"FINISHED"}
    assert poles(obj)[pole] == place and poles(obj)[:pole] == found[:pole]
    with pytest.raises(RuntimeError, match="on another part"):
        move(f"0:{place}")


@pytest.mark.parametrize(
    ("moves", "word"), [("1", "pairs such as"), ("99:3", "there are"), ("0:100000", "another part")]
)
def test_moves_that_are_none_change_nothing(moves, word):
    obj = torus()
    tile()
    before = everything(obj)
    with pytest.raises(RuntimeError, match=word):
        move(moves)
    assert everything(obj) == before


def test_a_pole_goes_onto_another_where_that_one_makes_way():
    obj = torus()
    tile()
    place = poles(obj)[1]
    assert move(f"0:{place}") == {"FINISHED"}
    assert poles(obj)[0] == place and len(set(poles(obj))) == len(poles(obj))
    obj = mesh_object("Sphere", *sphere_arrays(3))
    tile(poles="COUNT", pole_count=4)  # fewer cannot be
    before = everything(obj)
    with pytest.raises(RuntimeError, match="given twice"):
        move(f"0:{poles(obj)[1]}")
    assert everything(obj) == before


def test_poles_keep_to_their_vertex_group():
    obj = torus()
    group = obj.vertex_groups.new(name="Hidden")
    group.add(list(range(150)), 1.0, "REPLACE")
    tile(pole_group="Hidden")
    assert max(poles(obj)) < 150
    with pytest.raises(RuntimeError, match="not allowed"):
        move("0:200")


def test_the_operator_says_what_it_needs():
    obj = torus()
    with pytest.raises(RuntimeError, match="Select an object whose map has points"):
        move("")
    tile(poles="COUNT", pole_count=0)
    with pytest.raises(RuntimeError, match="Select an object whose map has points"):
        move("")
    tile(poles="AUTOMATIC")
    for vertex in obj.data.vertices:  # so that poles are placed elsewhere
        vertex.co.x *= 4.0 if vertex.co.x > 0 else 1.0
    with pytest.raises(RuntimeError, match="has changed since it was tiled"):
        move("")


def test_undo_takes_a_move_back():
    obj = torus()
    tile()
    before = poles(obj)
    bpy.ops.ed.undo_push(message="before")
    move(f"0:{neighbour(obj, before[0])}")
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert poles(bpy.data.objects["Torus"]) == before


def test_previews_write_the_map_alone_and_are_taken_back_exactly():
    obj = torus()
    tile()
    before, session = everything(obj), module("operators.drag_session").Session(obj)
    session.show(session.made({0: neighbour(obj, poles(obj)[0], 2)}))
    after = everything(obj)
    assert {name for name in before if after[name] != before[name]} == {"maps"}
    session.restore()
    assert everything(obj) == before


def test_the_texture_is_followed_in_the_background_and_given_up():
    obj = torus()
    tile()
    session = module("operators.drag_session").Session(obj)
    job = session.job({0: neighbour(obj, poles(obj)[0])})
    job.start()
    job.wait()
    assert session.taken(job).done
    job = session.job({0: neighbour(obj, poles(obj)[0], 2)})
    job.cancel()
    job.start()
    job.wait()
    assert job.results == [None]


def test_the_vertices_under_a_ray():
    obj = torus()
    obj.matrix_world = Matrix.Translation((5, 0, 0)) @ Matrix.Scale(2, 4)
    surface = module("operators.surface_pick").Surface(obj)
    points = mesh_io.world_points(obj)
    vertex = int(np.argmax(points[:, 2]))
    origin = Vector(points[vertex]) + Vector((0.01, 0.01, 10))
    found = surface.vertices_at(origin, Vector((0, 0, -1)))
    assert found[0] == vertex and len(found) == 4
    assert surface.vertices_at(Vector((0, 0, 10)), Vector((0, 0, -1))) == []


def test_the_nearest_pole_on_the_screen():
    nearest = module("operators.surface_pick").nearest
    view = SimpleNamespace(on_screen=lambda point: None if point[2] < 0 else (100 * point[0], 100 * point[1]))
    near = partial(nearest, view, [(0, 0, 1), (1, 1, 1), (0.5, 0.5, -1)])
    assert near(95, 104, 18) == 1 and near(10, 0, 18) == 0
    assert near(50, 50, 18) is None and nearest(view, [], 0, 0, 18) is None


@pytest.mark.parametrize("text", ["", "0:5", " 0:5  12:7 "])
def test_moves_as_text(text):
    found = drag.parsed_moves(text)
    assert found == {int(p): int(v) for p, v in (pair.split(":") for pair in text.split())}
