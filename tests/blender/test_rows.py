"""Rows of maps that turn: the dial, edges that are marked sharp, what is told and what is written."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import mesh_object, run, select, sphere_arrays, stored_report, uv

request, map_panel = module("operators.request"), module("interface.map_panel")
LINES = {"AUTOMATIC": "whole", "ANYWHERE": "none", "ALONG_EDGES": "free", "END_AT_EDGES": "whole", "MIRRORED": "mirror"}


def tile(**options):
    return bpy.ops.uv.holomorphic_tile(**{"turns": "QUARTER"} | options)


def button(**options):
    return run(main="SEAMLESS", **{"turns": "QUARTER"} | options)


def ball():
    return mesh_object("Ball", *sphere_arrays(3))


def box():
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    obj.modifiers.new("Finer", "SUBSURF").subdivision_type = "SIMPLE"
    obj.modifiers["Finer"].levels = 3
    bpy.ops.object.modifier_apply(modifier="Finer")
    return obj


def mark_equator(obj):
    """Marks the edges of the loop at half height sharp; their vertices."""
    heights = np.array([[obj.data.vertices[v].co.z for v in edge.vertices] for edge in obj.data.edges])
    chosen = np.flatnonzero((np.abs(heights) < 1e-6).all(axis=1))
    for edge in chosen.tolist():
        obj.data.edges[edge].use_edge_sharp = True
    return {frozenset(obj.data.edges[edge].vertices) for edge in chosen.tolist()}


def tilings(obj):
    return [part["tiling"] for part in stored_report(obj)["components"] if "tiling" in part]


def marked_pairs(obj):
    return {frozenset(edge.vertices) for edge in obj.data.edges if edge.use_edge_sharp}


def run_along(obj, pairs):
    """(n,) whether a coordinate of the map is one at both ends of each side along these edges."""
    at, found = uv(obj), []
    for face in obj.data.polygons:
        loops = list(face.loop_indices)
        for one, other in zip(loops, loops[1:] + loops[:1]):
            ends = frozenset(obj.data.loops[loop].vertex_index for loop in (one, other))
            if ends in pairs:
                found.append((at[one] == at[other]).any())
    return np.array(found)


@pytest.mark.parametrize("operator", [tile, button])
@pytest.mark.parametrize("rows", LINES)
def test_rows_lie_as_the_dial_says(operator, rows):
    obj = box()
    assert operator(rows=rows) == {"FINISHED"}
    (made,) = tilings(obj)
    assert (made["turns"], made["lines"]) == (4, LINES[rows])
    words = {"none": "8 cones", "free": "rows run along edges", "whole": "rows end at edges"}
    words = {**words, "mirror": "both halves are alike"}[LINES[rows]]
    assert stored_report(obj)["verdict"]["sentence"].endswith(words)


@pytest.mark.parametrize("operator", [tile, button])
def test_edges_marked_sharp_are_lines(operator):
    """Also where the surface is smooth, and as they are marked now."""
    obj = ball()
    operator(rows="ALONG_EDGES")
    assert tilings(obj)[0]["lines"] == "none"
    pairs = mark_equator(obj)
    operator(rows="ALONG_EDGES")
    assert tilings(obj)[0]["lines"] == "free" and len(pairs) >= 8
    along = run_along(obj, pairs)
    assert len(along) == 2 * len(pairs) and along.all()
    operator(rows="ANYWHERE")
    assert tilings(obj)[0]["lines"] == "none" and not run_along(obj, pairs).all()


def test_marks_on_the_result_of_modifiers():
    obj = ball()
    mark_equator(obj)
    obj.modifiers.new("Smooth", "SUBSURF").levels = 1
    tile(rows="ALONG_EDGES", modifiers=True)
    made = bpy.data.objects["Ball Mapped"]
    pairs = marked_pairs(made)
    assert len(pairs) > len(marked_pairs(obj)) and run_along(made, pairs).all()
    assert "marked" not in stored_report(made)["asked"]


def test_marks_of_selected_faces():
    """They are vertices of the mesh, of which a part is mapped."""
    obj = ball()
    pairs = mark_equator(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for face in obj.data.polygons:
        face.select = face.center.z > -0.6
    bpy.ops.object.mode_set(mode="EDIT")
    assert tile(rows="ALONG_EDGES") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert run_along(obj, pairs).all() and tilings(obj)[0]["lines"] == "free"


def test_each_object_has_its_own_marks():
    """Two with one shape are solved once."""
    one, other = ball(), ball()
    other.location.x = 5
    pairs = mark_equator(one)
    select(one, other)
    tile(rows="ALONG_EDGES", tiles=400, equal=False)
    assert [tilings(obj)[0]["lines"] for obj in (one, other)] == ["free", "none"]
    assert run_along(one, pairs).all()


def notes_of(press):
    """What the outcome of a run tells."""
    told, kind = [], request.Run
    write = kind.write

    def noted(self, *arguments):
        outcome = write(self, *arguments)
        told.extend(outcome.notes)
        return outcome

    kind.write = noted
    try:
        assert press() == {"FINISHED"}
    finally:
        kind.write = write
    return " ".join(told)


def test_rows_that_cannot_lie_so_are_told():
    ball()
    told = "Ball: rows do not lie at its edges: there are none, or tiles are too large for them"
    assert told in notes_of(lambda: tile(rows="END_AT_EDGES"))
    assert "rows" not in notes_of(lambda: tile(turns="NONE"))
    assert "rows" not in notes_of(lambda: tile(turns="FROM_TEXTURE", rows="AUTOMATIC"))


def test_the_dial_is_there_where_it_means_something():
    dials = box().holomorph_map
    dials.turns = "QUARTER"
    assert "rows" in map_panel.shown(dials)
    for dials.turns in ("NONE", "SIXTH"):
        assert "rows" not in map_panel.shown(dials)


def test_maps_that_do_not_turn_so_are_as_they_were():
    for turns in ("NONE", "SIXTH"):
        obj = box()
        tile(turns=turns)
        before = uv(obj)
        tile(turns=turns, rows="END_AT_EDGES")
        assert np.array_equal(uv(obj), before)
