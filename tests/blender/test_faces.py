"""Selected faces alone are mapped; the others keep their UVs."""

import bmesh
import bpy
import numpy as np
import pytest
from loaded_addon import module
from picked_faces import ACROSS, HALF, add_own_map, corners_of, leave, pick_faces
from scenes import (
    everything,
    grid_arrays,
    mesh_io,
    mesh_object,
    pick,
    run,
    select,
    stored_report,
    torus,
    torus_arrays,
    uv,
    uv_maps,
)


def test_a_selected_half_of_a_torus_is_a_pipe_and_the_rest_keeps_its_uvs():
    obj = torus()
    own = add_own_map(obj)
    pick_faces(obj, HALF)
    assert run() == {"FINISHED"}
    assert obj.mode == "EDIT"
    leave()
    entry = stored_report(obj)
    (part,) = entry["components"]
    assert entry["is_selection"] and entry["faces"] == len(HALF)
    assert (part["genus"], part["boundary_count"], part["faces"]) == (0, 2, len(HALF))
    assert entry["repairs"]["isolated_vertices"]["count"] == 0
    rest = np.setdiff1d(np.arange(len(obj.data.loops)), corners_of(HALF))
    assert np.array_equal(uv(obj)[rest], own[rest])
    assert np.array_equal(uv_maps.read_map(obj.data, "Artist"), own)
    new = uv(obj)[corners_of(HALF)]
    assert np.ptp(new, axis=0).max() == pytest.approx(1, abs=1e-6)


def test_selected_faces_get_what_they_get_as_a_mesh_of_their_own():
    obj = torus()
    pick_faces(obj, HALF)
    run(forms=1)
    leave()
    vertices, faces = torus_arrays()
    alone = mesh_object("Alone", vertices[: 13 * ACROSS], np.asarray(faces)[HALF])
    run(forms=1)
    for name in ("Holomorphic", "Holomorphic 1"):
        assert np.array_equal(uv(obj, name)[corners_of(HALF)], uv(alone, name)), name
    rest = np.setdiff1d(np.arange(len(obj.data.loops)), corners_of(HALF))
    assert not uv(obj)[rest].any()


def test_the_border_of_a_selection_is_marked_with_the_cuts():
    obj = torus()
    pick_faces(obj, HALF)
    run(seams=True)
    leave()
    marked = {tuple(sorted(pair)) for pair in mesh_io.marked_edges(obj.data, "use_seam").tolist()}
    rings = [start + np.arange(ACROSS) for start in (0, 12 * ACROSS)]  # vertices at the two ends of the pipe
    border = {tuple(sorted(pair)) for ring in rings for pair in np.stack([ring, np.roll(ring, -1)], 1).tolist()}
    assert border < marked and len(marked) == len(border) + stored_report(obj)["components"][0]["seam_edges"]


def test_a_second_selection_keeps_the_uvs_of_the_first():
    obj = torus()
    run()
    whole = uv(obj)
    pick_faces(obj, HALF)
    run()
    leave()
    first = uv(obj)
    other = np.setdiff1d(np.arange(len(obj.data.polygons)), HALF)
    pick_faces(obj, other)
    run(density=0.5)
    leave()
    assert np.array_equal(first[corners_of(other)], whole[corners_of(other)])
    assert np.array_equal(uv(obj)[corners_of(HALF)], first[corners_of(HALF)])
    assert np.ptp(uv(obj)[corners_of(other)], axis=0).max() == pytest.approx(0.5, abs=1e-6)


def test_a_selection_that_touches_itself_at_a_vertex_is_done():
    obj = mesh_object("Grid", *grid_arrays())
    touching = [0, 1, 8, 9]  # two strips, at vertex 9 between faces 1 and 8
    pick_faces(obj, touching)
    assert run() == {"FINISHED"}
    leave()
    entry = stored_report(obj)
    assert [(cut["reason"], cut["count"]) for cut in entry["repairs"]["cuts"]] == [("touching", 1)]
    assert [part["faces"] for part in entry["components"]] == [2, 2]
    assert (np.ptp(uv(obj)[corners_of(touching)], axis=0) > 0).all()


def test_repairs_name_faces_as_the_mesh_counts_them():
    vertices, faces = grid_arrays()
    faces[20] = faces[20][::-1]
    obj = mesh_object("Grid", vertices, faces)
    pick_faces(obj, [14, 15, 20, 21])
    run()
    leave()
    assert stored_report(obj)["repairs"]["reversed_faces"]["first"] == [20]


def test_hidden_faces_are_not_mapped_and_let_vertices_be_chosen_on_the_others():
    obj = mesh_object("Grid", *grid_arrays())
    own = add_own_map(obj)
    hidden = np.arange(18, 36)  # what is left is a rectangle of 3 x 6 faces
    pick_faces(obj, [], hidden)
    bpy.ops.mesh.select_mode(type="VERT")
    edited = bmesh.from_edit_mesh(obj.data)
    edited.verts.ensure_lookup_table()
    for index in (0, 6, 21, 27):
        edited.verts[index].select_set(True)
    bmesh.update_edit_mesh(obj.data)
    assert run() == {"FINISHED"}
    leave()
    (part,) = stored_report(obj)["components"]
    assert part["description"].startswith("rectangle with corners ") and part["faces"] == 18
    assert np.array_equal(uv(obj)[corners_of(hidden)], own[corners_of(hidden)])


def test_single_vertices_are_still_a_choice_and_other_uses_take_the_whole_mesh():
    obj = mesh_object("Grid", *grid_arrays())
    pick(obj, [24])
    run()
    assert stored_report(obj)["components"][0]["description"] == "disk map, centre at vertex 24"
    pick_faces(obj, [0])
    run(use_selection="NONE")
    leave()
    assert stored_report(obj)["faces"] == 36 and not stored_report(obj)["is_selection"]


def test_objects_of_which_nothing_is_selected_are_left_alone():
    first, second = torus("First"), torus("Second")
    select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    pick_faces(first, HALF)
    assert run() == {"FINISHED"}
    leave()
    assert not second.data.uv_layers and first.data.uv_layers


def test_faces_that_are_asked_for_and_are_not_there_are_refused():
    obj = torus()
    pick_faces(obj, [])
    before = everything(obj)
    with pytest.raises(RuntimeError, match="select the faces"):
        run(use_selection="FACES")
    assert everything(obj) == before
    leave()
    with pytest.raises(RuntimeError, match="select the faces"):
        run(use_selection="FACES")


def test_all_faces_selected_is_the_whole_mesh():
    obj = torus()
    run(checker=False)
    expected = uv(obj)
    pick_faces(obj, range(len(obj.data.polygons)))
    run(checker=False)
    leave()
    assert np.array_equal(uv(obj), expected) and not stored_report(obj)["is_selection"]


def test_selected_faces_that_are_no_surface_are_cut():
    vertices, faces = grid_arrays()
    obj = mesh_object("Bad", [*vertices, (0, 0, 9)], [*faces, (0, 1, 49), (0, 1, 25)])
    pick_faces(obj, [0, 36, 37])
    assert run() == {"FINISHED"}
    leave()
    (cut,) = stored_report(obj)["repairs"]["cuts"]
    assert cut["reason"] == "many_faces" and cut["first"] == [[0, 1]]
    pick_faces(obj, [0, 1, 6, 7])  # the others do not matter
    assert run() == {"FINISHED"}
    leave()
    assert not stored_report(obj)["repairs"]["cuts"]


def test_selected_faces_are_tiled_and_poles_are_not_dragged_on_them():
    obj = torus()
    own = add_own_map(obj)
    pick_faces(obj, HALF)
    assert bpy.ops.uv.holomorphic_tile(tiles=20) == {"FINISHED"}
    leave()
    rest = np.setdiff1d(np.arange(len(obj.data.loops)), corners_of(HALF))
    assert np.array_equal(uv(obj)[rest], own[rest])
    assert stored_report(obj)["components"][0]["faces"] == len(HALF)
    with pytest.raises(ValueError, match="selected faces"):
        module("operators.drag_session").Session(obj)


def test_a_ninth_map_of_a_selection_is_an_attribute_and_keeps_its_rest():
    obj = torus()
    for index in range(8):
        add_own_map(obj, f"Own {index}")
    active = uv_maps.read_map(obj.data, obj.data.uv_layers.active.name)
    pick_faces(obj, HALF)
    run()
    run(density=2)
    leave()
    assert {entry["stored_as"] for entry in stored_report(obj)["maps"]} == {"attribute"}
    rest = np.setdiff1d(np.arange(len(obj.data.loops)), corners_of(HALF))
    assert np.array_equal(uv_maps.read_map(obj.data, "Holomorphic")[rest], active[rest])
