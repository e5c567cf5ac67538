"""What cannot be done is said in one sentence, and the object is the same as before, bit for bit."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    everything,
    linked,
    mesh_object,
    moebius,
    pick,
    run,
    select,
    stored_report,
    torus,
    torus_arrays,
    uv,
    written,
)


def fin():
    vertices, faces = torus_arrays()
    faces = [*map(tuple, faces), (faces[0][0], faces[0][1], len(vertices))]
    return mesh_object("Bad", [*vertices, (0, 0, 2)], faces)


def with_vertex(index, value):
    vertices, faces = torus_arrays()
    vertices = vertices.copy()
    vertices[index, 1] = value
    return mesh_object("Bad", vertices, faces)


def not_a_number():
    vertices, faces = torus_arrays()
    return mesh_object("Bad", vertices * np.nan, faces), "vertex 0 has a coordinate that is not a number"


def infinite():
    vertices, faces = torus_arrays()
    return mesh_object("Bad", vertices + np.inf, faces), "infinite"


def zero_area():
    vertices, faces = torus_arrays()
    return mesh_object("Bad", np.zeros_like(vertices), faces), "area"


def flattened_by_its_scale():
    obj = torus("Bad")
    obj.scale = (0, 0, 0)
    return obj, "area"


def doubled(step=1):
    vertices, faces = torus_arrays()
    return mesh_object("Bad", vertices, [*faces, *faces[:, ::step]])


def empty():
    return mesh_object("Bad", [], []), "face"


def no_faces():
    obj = mesh_object("Bad", [(0, 0, 0), (1, 0, 0)], [])
    obj.data.edges.add(1)
    obj.data.edges[0].vertices = (0, 1)
    return obj, "face"


BAD = [not_a_number, infinite, zero_area, flattened_by_its_scale, empty, no_faces]
CUT = {
    "fin": (fin, "Bad: cut along 1 edge that has three or more faces"),
    "moebius": (moebius, "Bad: cut along 1 edge of a part that has only one side"),
    "twice": (doubled, "Bad: 288 faces occur twice: their copies are separate"),
    "two sides": (lambda: doubled(-1), "Bad: 288 faces have two sides: each side is separate"),
}


def bystanders(obj):
    """Things of the artist that a refusal must leave alone."""
    obj.data.uv_layers.new(name="Artist")
    obj.data.materials.append(bpy.data.materials.new("Mine"))
    if len(obj.data.edges):
        obj.data.edges[0].use_seam = True


@pytest.mark.parametrize("make", BAD)
def test_refused_with_one_sentence_and_untouched(make):
    obj, word = make()
    bystanders(obj)
    bpy.context.view_layer.update()
    before = everything(obj)
    with pytest.raises(RuntimeError, match=word) as caught:
        run(seams=True)
    assert everything(obj) == before
    message = str(caught.value).removeprefix("Error: ").strip()
    assert message.startswith("Bad: ") and "\n" not in message and "Traceback" not in message


@pytest.mark.parametrize("make", BAD)
def test_the_other_selected_objects_are_still_done(make):
    bad, _ = make()
    bystanders(bad)
    bpy.context.view_layer.update()
    before = everything(bad)
    good = torus("Good")
    select(bad, good)
    assert run() == {"FINISHED"}
    assert everything(bad) == before
    assert [layer.name for layer in good.data.uv_layers] == ["Holomorphic", "Holomorphic 1"]


def face_extents(obj):
    """The larger side of the box of each face's UVs."""
    values = uv(obj)
    rows = (values[polygon.loop_start : polygon.loop_start + polygon.loop_total] for polygon in obj.data.polygons)
    return np.array([np.ptp(row, axis=0).max() for row in rows])


@pytest.mark.parametrize("name", CUT)
def test_every_face_gets_a_map_and_cuts_are_told(name):
    make, sentence = CUT[name]
    obj = make()
    before = [tuple(polygon.vertices) for polygon in obj.data.polygons]
    assert run() == {"FINISHED"}
    assert (face_extents(obj) > 0).all()
    assert [tuple(polygon.vertices) for polygon in obj.data.polygons] == before
    assert all(part["done"] for part in stored_report(obj)["components"])
    outcome = written(obj, main="BALANCED")
    assert any(sentence.removeprefix("Bad: ") in line for line in outcome.notes + outcome.problems)
    assert sentence[5].upper() + sentence[6:] in obj.holomorph_map.made.summary.splitlines()


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_only_the_faces_that_are_not_finite_are_left_out(value):
    obj = with_vertex(7, value)
    assert run() == {"FINISHED"}
    at_vertex = [7 in polygon.vertices for polygon in obj.data.polygons]
    assert ((face_extents(obj) > 0) != at_vertex).all()
    (problem,) = [line for line in written(obj, main="BALANCED").problems if "left out: " in line]
    assert problem.startswith("Bad: 4 faces left out: vertex 7 has a coordinate that is")
    assert stored_report(obj)["whole"]["unmapped_faces"] == 4


@pytest.mark.parametrize(("dial", "name"), [("size", "Size"), ("evenness", "Evenness"), ("rotation", "Rotation")])
def test_numbers_of_scripts_that_are_none_are_named(dial, name):
    """The limits of a property do not hold them back."""
    obj = torus()
    before = everything(obj)
    with pytest.raises(RuntimeError, match=f"Error: {name} is nan; a finite number is needed"):
        bpy.ops.uv.holomorphic_tile(**{dial: np.nan})
    assert everything(obj) == before


def test_poles_are_where_they_were_chosen_on_a_part_that_was_cut():
    obj = doubled(-1)
    pick(obj, [0, 40])
    assert run(use_selection="POLES") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert (face_extents(obj) > 0).all()


def test_tori_that_share_a_vertex_are_done():
    vertices, faces = torus_arrays()
    second = np.where(faces == 0, 0, faces + len(vertices) - 1)
    obj = mesh_object("Two", [*vertices, *(vertices[1:] + (0, 0, 3))], [*faces, *second])
    assert run(seams=True) == {"FINISHED"}
    entry = stored_report(obj)
    assert [(part["done"], part["genus"]) for part in entry["components"]] == [(True, 1), (True, 1)]
    (cut,) = entry["repairs"]["cuts"]
    assert (cut["reason"], cut["count"], cut["first"]) == ("touching", 1, [0])


def test_faces_that_are_all_apart_are_joined_and_told_of():
    vertices, faces = torus_arrays()
    corners = np.asarray(faces)
    obj = mesh_object("Loose", vertices[corners].reshape(-1, 3), np.arange(corners.size).reshape(corners.shape))
    assert run() == {"FINISHED"}
    (part,) = stored_report(obj)["components"]
    assert (part["genus"], part["boundary_count"]) == (1, 0)
    assert any("vertices joined" in line for line in written(obj, main="BALANCED").problems)


def test_maps_of_an_earlier_run_survive_a_refusal():
    obj = torus()
    run()
    for vertex in obj.data.vertices:
        vertex.co.x = np.nan
    before = everything(obj)
    with pytest.raises(RuntimeError):
        run()
    assert everything(obj) == before


def test_a_linked_mesh_is_refused(tmp_path):
    torus("Linked")
    obj = linked(tmp_path)
    good = torus("Good")
    select(obj, good)
    assert run() == {"FINISHED"}
    assert not obj.data.uv_layers and good.data.uv_layers
    select(obj)
    with pytest.raises(RuntimeError, match="make it local"):
        run()


def test_no_mesh_selected():
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.scene.collection.objects.link(camera)
    select(camera)
    assert not bpy.ops.uv.holomorphic_maps.poll()


def test_only_the_librarys_errors_are_caught(monkeypatch):
    obj = torus()
    before = everything(obj)

    def broken(*_):
        raise ZeroDivisionError("our own mistake")

    monkeypatch.setattr(module("solving.jobs"), "solve", broken)
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        run()
    assert everything(obj) == before


def test_helpers_of_the_importer_are_not_mapped():
    helper = torus("Icosphere")
    collection = bpy.data.collections.new("glTF_not_exported")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(helper)
    good = torus("Good")
    select(helper, good)
    assert run() == {"FINISHED"}
    assert not helper.data.uv_layers and good.data.uv_layers


@pytest.mark.parametrize("far", [1e13, 4.9e26])
def test_a_wild_vertex_is_named_and_the_rest_gets_its_map(far):
    obj = with_vertex(7, far)
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    report = stored_report(obj)
    (left_out,) = [part for part in report["components"] if not part["done"]]
    assert left_out["reason"].startswith("vertex 7 is more than 1e9 times as far away") and left_out["faces"] == 4
    kept = [k for k, polygon in enumerate(obj.data.polygons) if 7 not in polygon.vertices]
    corners = np.concatenate([obj.data.polygons[k].loop_indices for k in kept])
    assert np.ptp(uv(obj).reshape(-1, 2)[corners], axis=0).min() > 0.1
