"""Cones of maps that turn, dragged as poles are: by the operator as scripts call it, and a session without events."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import everything, mesh_object, native, select, sphere_arrays, stored_report, torus, turned_jumps, uv

drag_session, marks, overlay, report = (
    module(name) for name in ("operators.drag_session", "overlays.marks_view", "overlays.overlay", "results.report")
)


def ball(name="Ball"):
    return mesh_object(name, *sphere_arrays(3))


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**{"turns": "QUARTER", "rows": "ANYWHERE"} | options)


def move(moves):
    return bpy.ops.uv.holomorphic_drag_poles(moves=moves)


def cones(obj):
    (tiling,) = [part["tiling"] for part in stored_report(obj)["components"]]
    return dict(zip(tiling["cones"], tiling["cone_angles"]))


def neighbour(obj, vertex):
    return neighbour_of(obj, vertex, cones(obj))


def neighbour_of(obj, vertex, taken=()):
    near = [set(edge.vertices) - {vertex} for edge in obj.data.edges if vertex in edge.vertices]
    return next(v for (v,) in near if v not in taken)


@pytest.mark.parametrize("turns", ["HALF", "QUARTER"])
@pytest.mark.parametrize("make", [ball, torus])
def test_a_cone_moves_and_the_whole_numbers_follow(make, turns):
    obj = make()
    tile(turns=turns)
    before, found = uv(obj), cones(obj)
    first, angle = next(iter(found.items()))
    place = neighbour(obj, first)
    assert move(f"0:{place}") == {"FINISHED"}
    del found[first]
    assert cones(obj) == dict(sorted((found | {place: angle}).items()))
    assert not np.array_equal(uv(obj), before)
    _, shift, off = turned_jumps(obj, {"HALF": 2, "QUARTER": 4}[turns])
    assert off.max() == 0 and np.array_equal(shift, np.round(shift))


def test_a_second_drag_goes_on_from_the_first():
    """Cones are numbered as the report has them; the earlier one stays where it was dragged."""
    obj = ball()
    tile()
    first, second = list(cones(obj))[:2]
    place = neighbour(obj, first)
    move(f"0:{place}")
    index = list(cones(obj)).index(second)
    other = neighbour(obj, second)
    move(f"{index}:{other}")
    assert {place, other} <= set(cones(obj)) and not {first, second} & set(cones(obj))
    move(f"{list(cones(obj)).index(place)}:{first} {list(cones(obj)).index(other)}:{second}")
    again = uv(obj)
    tile()
    assert first in cones(obj) and second in cones(obj) and np.array_equal(uv(obj), again)


def test_no_move_is_what_there_is():
    obj = ball()
    tile()
    before = uv(obj)
    assert move("") == {"FINISHED"} and np.array_equal(uv(obj), before)


REFUSED = {
    "0:{taken}": "point 0 cannot move to vertex {taken}, which is no place of its own inside its part",
    "0:{boundary}": "point 0 cannot move to vertex {boundary}, which is no place of its own inside its part",
    "90:3": "point 90 does not exist: there are",
    "0-3": "pairs such as",
}


@pytest.mark.parametrize("moves", REFUSED)
def test_where_a_cone_cannot_go(moves):
    obj = mesh_object("Bowl", *bowl_arrays())
    tile(turns="QUARTER")
    before, found = everything(obj), list(cones(obj))
    ends = np.array([edge.vertices[:] for edge in obj.data.edges])
    count = np.bincount(np.array([loop.edge_index for loop in obj.data.loops]))
    words = {"taken": found[1], "boundary": int(ends[count == 1][0, 0])}
    with pytest.raises(RuntimeError, match=REFUSED[moves].format(**words)):
        move(moves.format(**words))
    assert everything(obj) == before


def bowl_arrays():
    """A ball without its lower half."""
    vertices, faces = sphere_arrays(3)
    kept = [face for face in faces if np.mean([vertices[v][2] for v in face]) > -0.05]
    used = sorted({v for face in kept for v in face})
    number = {v: k for k, v in enumerate(used)}
    return [vertices[v] for v in used], [tuple(number[v] for v in face) for face in kept]


def test_two_cones_cannot_go_to_one_place():
    obj = ball()
    tile()
    before = everything(obj)
    place = neighbour(obj, next(iter(cones(obj))))
    with pytest.raises(RuntimeError, match="two points cannot move to one vertex"):
        move(f"0:{place} 1:{place}")
    assert everything(obj) == before


def test_a_map_that_would_lose_too_much_is_refused_in_a_sentence(monkeypatch):
    other = torus()
    tile()
    obj = ball()
    tile()
    before, session = everything(obj), drag_session.Session(obj)
    search = native.load().maps.map
    lost = native.load().TopologyError("it would lose 3 % of its area")
    monkeypatch.setattr(search, "map_objects", lambda objects, size, **_: [search.MappedParts([lost], size)])
    with pytest.raises(ValueError, match="it would lose 3 % of its area"):
        session.made({0: neighbour(obj, int(session.poles[0]))})
    module("solving.jobs").KEPT.clear()
    with pytest.raises(ValueError, match="it would lose 3 % of its area"):
        drag_session.Session(other)
    assert everything(obj) == before


def test_rows_at_edges_give_way_to_a_cone_that_is_dragged():
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    obj.modifiers.new("Finer", "SUBSURF").subdivision_type = "SIMPLE"
    obj.modifiers["Finer"].levels = 3
    bpy.ops.object.modifier_apply(modifier="Finer")
    tile(rows="END_AT_EDGES")
    place = neighbour(obj, next(iter(cones(obj))))
    assert move(f"0:{place}") == {"FINISHED"}
    (tiling,) = [part["tiling"] for part in stored_report(obj)["components"]]
    assert place in tiling["cones"] and tiling["lines"] == "none"


def test_a_session_shows_and_gives_back():
    obj = ball()
    tile()
    before = everything(obj)
    session = drag_session.Session(obj)
    assert session.are_cones and session.poles.tolist() == list(cones(obj)) and not len(session.zeros)
    place = neighbour(obj, int(session.poles[2]))
    job = session.job({2: place})
    job.run()
    session.show(session.taken(job))
    assert session.poles[2] == place and len(session.poles) == len(cones(obj))
    assert session.place(2) == (0, 2) and session.may_go_to(2, place) and not session.may_go_to(1, place)
    session.restore()
    assert everything(obj) == before


def test_cones_of_several_parts():
    obj = mesh_object("Both", *two_balls())
    tile()
    tilings = [part["tiling"] for part in stored_report(obj)["components"]]
    first = len(tilings[0]["cones"])
    session = drag_session.Session(obj)
    assert session.place(first) == (1, 0)
    vertex = int(session.poles[first])
    near = next(v for edge in obj.data.edges if vertex in edge.vertices for v in edge.vertices if v != vertex)
    assert move(f"{first}:{near}") == {"FINISHED"}
    after = [part["tiling"]["cones"] for part in stored_report(obj)["components"]]
    assert after[0] == tilings[0]["cones"] and near in after[1]
    with pytest.raises(RuntimeError, match="no place of its own inside its part"):
        move(f"0:{near + 1}")


def two_balls():
    vertices, faces = sphere_arrays(3)
    moved = [(x + 2, 0.7 * y, z) for x, y, z in vertices]
    return vertices + moved, faces + [tuple(v + len(vertices) for v in face) for face in faces]


def test_points_of_a_map_in_pieces_are_shown_and_stay():
    """As of a body that is cut open where few see it: the tiling is that of a piece."""
    obj = ball()
    tile()
    select(obj)
    entry, places = stored_report(obj), sorted(cones(obj))
    part = entry["components"][0]
    part["tilings"] = [part.pop("tiling")]
    report.store(obj, entry)
    points, kinds, _ = marks._points(obj, None)
    assert len(points) == len(places) and (kinds == marks.CONE).all()
    made = obj.holomorph_map.made
    assert made.point_count == len(places) and made.movable_count == 0
    with pytest.raises(RuntimeError, match="cut stay where they are: set Seams in Advanced to None"):
        move(f"0:{neighbour_of(obj, places[0])}")


def test_dots_follow_the_pointer():
    obj = ball()
    tile()
    select(obj)
    places = np.array(list(cones(obj)))
    places[0] = neighbour(obj, int(places[0]))
    dragged = overlay.Dragged(places, np.empty(0, np.int64), 0, are_cones=True)
    points, kinds, hovered = marks._points(obj, dragged)
    assert len(points) == len(places) and (kinds == marks.CONE).all() and hovered.tolist() == [True] + [False] * 7
    assert np.allclose(points[0], obj.data.vertices[int(places[0])].co)
