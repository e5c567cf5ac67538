"""The operator on meshes of a few hundred faces: what it writes, where, and what it leaves alone."""

import json

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    edge_mismatch,
    everything,
    fills_the_square,
    frame,
    mesh_io,
    mesh_object,
    run,
    select,
    shown_scale,
    sphere_arrays,
    stored_report,
    torus,
    torus_arrays,
    two_parts,
    uv,
    uv_maps,
)


def names(obj):
    return [layer.name for layer in obj.data.uv_layers]


def test_maps_are_written_and_the_main_one_is_active():
    obj = torus()
    assert run() == {"FINISHED"}
    assert names(obj) == ["Holomorphic", "Holomorphic 1"]
    assert obj.data.uv_layers.active.name == "Holomorphic"
    assert obj.data.uv_layers["Holomorphic"].active_render


def test_each_map_fills_the_uv_square_and_fits_along_the_seams():
    obj = torus()
    run()
    for name in names(obj):
        values = uv(obj, name)
        assert fills_the_square(values)
        difference, forgiven = edge_mismatch(obj.data, values)
        assert difference <= forgiven


def test_the_map_is_conformal_up_to_linear_interpolation():
    error = []
    for fineness in (2, 4):
        obj = torus(around=24 * fineness, across=12 * fineness)
        run(evenness=0)
        quality = stored_report(obj)["components"][0]["main_map"]
        assert quality["flipped_triangles"] == 0
        error.append(quality["mean_angle"] - 1)
    assert 0.4 < error[1] / error[0] < 0.6


def test_density_and_rotation_are_applied_to_all_maps():
    obj = torus()
    run()
    before = {name: uv(obj, name) - 0.5 for name in names(obj)}
    run(density=2.0)
    for name in before:
        assert fills_the_square(uv(obj, name), density=2.0)
    run(density=2.0, rotation=np.pi / 2)
    for name, values in before.items():
        turned = 2 * np.stack([-values[:, 1], values[:, 0]], 1)
        assert np.allclose(uv(obj, name) - 0.5, turned, atol=1e-5)


def test_a_second_run_replaces_and_the_artists_maps_stay():
    obj = torus()
    artist = obj.data.uv_layers.new(name="Artist").name
    values = np.random.default_rng(1).random((len(obj.data.loops), 2)).astype(np.float32)
    mesh_io.write_values(module("compatibility").uv_values(obj.data.uv_layers[artist]), values)
    for _ in range(3):
        run()
        assert names(obj) == ["Artist", "Holomorphic", "Holomorphic 1"]
    assert np.array_equal(uv_maps.read_map(obj.data, "Artist"), values)


def test_more_forms_than_uv_maps_become_corner_attributes():
    obj = frame()
    assert run(forms=20) == {"FINISHED"}
    written = stored_report(obj)["maps"]
    assert [m["name"] for m in written] == ["Holomorphic", *(f"Holomorphic {j}" for j in range(1, 14))]
    assert [m["stored_as"] for m in written] == ["uv_map"] * 8 + ["attribute"] * 6
    for m in written:
        assert fills_the_square(uv(obj, m["name"]))
    run(forms=8)
    assert len(stored_report(obj)["maps"]) == 9
    assert "Holomorphic 13" not in obj.data.attributes
    assert "Holomorphic 8" in obj.data.attributes or "Holomorphic 8" in obj.data.uv_layers


def test_no_free_uv_map_at_all():
    obj = torus()
    for index in range(8):
        obj.data.uv_layers.new(name=f"Artist {index}")
    active = obj.data.uv_layers.active.name
    assert run() == {"FINISHED"}
    assert [m["stored_as"] for m in stored_report(obj)["maps"]] == ["attribute"] * 2
    assert fills_the_square(uv(obj))
    assert names(obj)[:8] == [f"Artist {index}" for index in range(8)]
    if bpy.app.version < (4, 0, 0):  # later, such an attribute is a UV map all the same, and can be active
        assert obj.data.uv_layers.active.name == active
    tree = obj.material_slots[0].material.node_tree
    assert any(n.type == "ATTRIBUTE" and n.attribute_name == "Holomorphic" for n in tree.nodes)


def test_shown_map_is_active():
    obj = torus()
    run(shown=1)
    assert obj.data.uv_layers.active.name == "Holomorphic 1"
    tree = obj.material_slots[0].material.node_tree
    assert [n.uv_map for n in tree.nodes if n.type == "UVMAP"] == ["Holomorphic 1"]


def test_seams_are_added_only_if_asked_for_and_none_is_removed():
    obj = torus()
    mine = np.zeros(len(obj.data.edges), bool)
    mine[[3, 5, 8]] = True
    obj.data.edges.foreach_set("use_seam", mine)
    run()
    assert np.array_equal(mesh_io.read_seams(obj.data), mine)
    run(seams=True)
    seams = mesh_io.read_seams(obj.data)
    assert seams[mine].all()
    entry = stored_report(obj)
    assert np.count_nonzero(seams & ~mine) == entry["seams_added"] > 0
    # Cut open along its seams, the torus is a disk: the map is continuous everywhere else.
    assert np.count_nonzero(seams) <= entry["components"][0]["seam_edges"] + 3


def test_the_map_jumps_only_at_seams():
    obj = torus()
    run(seams=True)
    mesh, values = obj.data, uv(obj)
    seams = mesh_io.read_seams(mesh)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    count = len(mesh.vertices)
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, corners, values)
    np.maximum.at(high, corners, values)
    torn = (high - low).max(axis=1) > 1e-4
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    on_seam = np.zeros(count, bool)
    on_seam[ends.reshape(-1, 2)[seams].ravel()] = True
    assert np.array_equal(torn, on_seam)


def test_nothing_but_maps_changes():
    obj = torus()
    before = everything(obj)
    run(checker=False)
    after = everything(obj)
    for key in ("positions", "corners", "offsets", "edges", "seams", "materials"):
        assert before[key] == after[key]


def test_the_objects_scale_counts():
    plain, stretched = torus("Plain"), torus("Stretched")
    stretched.scale = (2.0, 1.0, 0.5)
    vertices, faces = torus_arrays()
    select(plain, stretched)
    run()
    assert not np.allclose(uv(plain), uv(stretched), atol=1e-2)
    tau = [stored_report(o)["components"][0]["period_matrix"][0][0][1] for o in (plain, stretched)]
    assert abs(tau[0] - tau[1]) > 0.01
    applied = two_parts("Applied", (vertices * (2, 1, 0.5), faces), (vertices * (2, 1, 0.5), faces))
    run()
    parts = stored_report(applied)["components"]
    assert parts[0]["period_matrix"][0][0][1] == pytest.approx(tau[1], rel=1e-5)


@pytest.mark.parametrize("transform", ["moved", "rotated", "mirrored"])
def test_isometries_of_the_object_change_nothing(transform):
    obj = torus()
    run()
    before = stored_report(obj)["components"][0]["period_matrix"][0][0][1]
    if transform == "moved":
        obj.location = (5, -3, 100)
    elif transform == "rotated":
        obj.rotation_euler = (0.3, 0.7, -1.1)
    else:
        obj.scale.x = -1
    bpy.context.view_layer.update()
    run()
    after = stored_report(obj)["components"][0]["period_matrix"][0][0][1]
    assert after == pytest.approx(before, rel=1e-6)


def test_several_objects_in_one_run():
    first, second, third = torus("First"), torus("Second", thickness=0.25), torus("Third")
    select(first, second)
    assert run() == {"FINISHED"}
    assert names(first) == names(second) == ["Holomorphic", "Holomorphic 1"]
    assert names(third) == []
    text = json.loads(bpy.data.texts["Holomorphic Report"].as_string())
    assert sorted(o["object"] for o in text["objects"]) == ["First", "Second"]


def test_objects_that_share_a_mesh():
    first = torus("First")
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.scene.collection.objects.link(second)
    select(first, second)
    assert run() == {"FINISHED"}
    assert names(first) == ["Holomorphic", "Holomorphic 1"]


@pytest.mark.parametrize(("scale", "told"), [((1, 1, 1), False), ((-2, 2, 2), False), ((1, 2, 1), True)])
def test_another_scale_of_a_shared_mesh_is_told(scale, told):
    first = torus("First")
    second = bpy.data.objects.new("Second", first.data)
    second.scale = scale
    second.rotation_euler = (0.4, 0.1, 2)
    bpy.context.scene.collection.objects.link(second)
    bpy.context.view_layer.update()
    (target,) = module("scene.targets").collect([first, second])
    assert ("the scale of First is used" in target.note) == told


def test_parts_of_one_mesh_of_different_kinds():
    obj = two_parts("Mixed", torus_arrays(), sphere_arrays())
    assert run() == {"FINISHED"}
    entry = stored_report(obj)
    assert [(c["genus"], c["done"], c["forms"]) for c in entry["components"]] == [(1, True, 1), (0, True, 1)]
    assert fills_the_square(uv(obj))


def test_parts_with_fewer_forms_are_zero_in_the_other_maps():
    bm_frame = frame("Source").data
    vertices = [tuple(v.co) for v in bm_frame.vertices]
    faces = [tuple(p.vertices) for p in bm_frame.polygons]
    obj = two_parts("Both", torus_arrays(), (vertices, faces))
    run(forms=2)
    corners = 4 * len(torus_arrays()[1])
    assert names(obj) == ["Holomorphic", "Holomorphic 1", "Holomorphic 2"]
    assert np.all(uv(obj, "Holomorphic 2")[:corners] == 0)
    assert fills_the_square(uv(obj, "Holomorphic 2")[corners:])
    assert fills_the_square(uv(obj))


def test_checker_nodes():
    obj = torus()
    run(checker_scale=10)
    material = obj.material_slots[0].material
    tree = material.node_tree
    active = tree.nodes.active
    assert active.type == "TEX_IMAGE" and active.interpolation == "Closest"
    assert active.image.packed_file is not None and tuple(active.image.size) == (250, 250)
    checker = next(n for n in tree.nodes if n.type == "TEX_CHECKER")
    assert checker.outputs[0].links[0].to_socket.name == "Base Color"
    scale = checker.inputs["Scale"].links[0].from_node
    assert scale.type == "VALUE" and scale.outputs[0].default_value == 10
    shift = checker.inputs["Vector"].links[0].from_node  # to the middle of a square, for maps that turn
    assert shift.type == "VECT_MATH" and not any(shift.inputs[1].default_value)
    uv_node = shift.inputs[0].links[0].from_node
    assert uv_node.type == "UVMAP" and uv_node.uv_map == "Holomorphic"
    run(checker_scale=30)
    assert obj.material_slots[0].material == material
    assert scale.outputs[0].default_value == 30 and tuple(active.image.size) == (240, 240)


def test_the_checker_suits_the_size_and_shows_the_density():
    obj = torus()
    run()
    squares = shown_scale(obj)
    assert 10 <= squares <= 60 and squares % 2 == 0
    run(density=0.5)
    assert shown_scale(obj) == squares
    obj.scale = (100, 100, 100)
    bpy.context.view_layer.update()
    run()
    assert shown_scale(obj) == squares


def test_the_artists_materials_come_back():
    obj = torus()
    mine, own = bpy.data.materials.new("Mine"), bpy.data.materials.new("Own")
    obj.data.materials.append(mine)
    obj.data.materials.append(None)
    obj.data.materials.append(mine)
    obj.material_slots[2].link = "OBJECT"
    obj.material_slots[2].material = own
    before = [(s.link, s.material) for s in obj.material_slots]
    for _ in range(2):
        run()
    assert all(s.material.name == "Holomorphic Checker" for s in obj.material_slots)
    assert list(obj.data.materials)[:2] == [mine, None]
    assert bpy.ops.uv.holomorphic_restore_materials() == {"FINISHED"}
    assert [(s.link, s.material) for s in obj.material_slots] == before
    assert bpy.ops.uv.holomorphic_restore_materials() == {"CANCELLED"}


def test_a_checker_on_a_bare_object_goes_away_again():
    obj = torus()
    run()
    assert len(obj.material_slots) == 1
    bpy.ops.uv.holomorphic_restore_materials()
    assert len(obj.material_slots) == 0


def test_report_is_json_and_complete():
    obj = torus()
    run()
    entry = stored_report(obj)
    part = entry["components"][0]
    assert part["genus"] == 1 and part["boundary_count"] == 0
    assert part["period_matrix"][0][0][1] > 0
    lower, upper = np.array(part["period_bounds"])
    assert lower[0, 0] <= part["period_matrix"][0][0][1] <= upper[0, 0]
    assert max(part["residuals"].values()) < 1e-8
    assert part["timings"]["total"] > 0
    text = json.loads(bpy.data.texts["Holomorphic Report"].as_string())
    assert text["objects"] == [entry]


def test_edit_mode_writes_the_same_and_comes_back():
    obj = torus()
    run()
    expected = uv(obj)
    run(checker=False)
    bpy.ops.object.mode_set(mode="EDIT")
    assert run() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(uv(obj), expected)


def test_edit_mode_sees_pending_edits_and_several_objects():
    first, second, selected = torus("First"), torus("Second"), torus("Selected")
    select(first, second)
    bpy.ops.object.mode_set(mode="EDIT")
    selected.select_set(True)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    assert run() == {"FINISHED"}
    assert (first.mode, second.mode, selected.mode) == ("EDIT", "EDIT", "OBJECT")
    assert selected.select_get()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(first.data.polygons) == 4 * 24 * 12
    assert names(first) == names(second) == ["Holomorphic", "Holomorphic 1"]
    assert names(selected) == []
    assert fills_the_square(uv(first))


def test_undo_takes_everything_back_in_one_step_and_redo_brings_it_again():
    obj = torus()
    obj.data.uv_layers.new(name="Artist")
    bpy.ops.ed.undo_push(message="before")
    run(seams=True)
    expected = uv(obj)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Torus"]
    assert names(obj) == ["Artist"]
    assert "holomorph_report" not in obj and not obj.material_slots
    assert "Holomorphic Report" not in bpy.data.texts
    assert not mesh_io.read_seams(obj.data).any()
    bpy.ops.ed.redo()
    obj = bpy.data.objects["Torus"]
    assert names(obj) == ["Artist", "Holomorphic", "Holomorphic 1"]
    assert np.array_equal(uv(obj), expected)


def test_a_second_run_solves_nothing(monkeypatch):
    torus()
    run()
    solve = module("solving.jobs")

    def forbidden(*_):
        raise AssertionError("solved again")

    monkeypatch.setattr(solve, "solved_anew", forbidden)
    assert run(density=3.0, seams=True) == {"FINISHED"}


def test_an_edited_mesh_is_solved_again():
    obj = torus()
    run()
    before = uv(obj)
    obj.data.vertices[0].co *= 1.01
    run()
    assert not np.array_equal(uv(obj), before)


def test_loose_vertices_and_edges_do_not_matter():
    obj = torus()
    run()
    expected = uv(obj)
    mesh = obj.data
    count = len(mesh.vertices)
    mesh.vertices.add(2)
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (count, count + 1)
    assert run(seams=True) == {"FINISHED"}
    assert len(mesh.vertices) == count + 2
    assert np.allclose(uv(obj), expected, atol=1e-6)


def test_flipped_faces_are_handled_and_not_turned():
    vertices, faces = torus_arrays()
    faces = faces.copy()
    faces[::3] = faces[::3, ::-1]
    obj = mesh_object("Flipped", vertices, faces)
    before = everything(obj)
    assert run() == {"FINISHED"}
    assert everything(obj)["corners"] == before["corners"]
    repaired = stored_report(obj)["repairs"]["reversed_faces"]
    assert repaired["count"] in {len(faces[::3]), len(faces) - len(faces[::3])}
    difference, forgiven = edge_mismatch(obj.data, uv(obj))
    assert difference <= forgiven


def test_shape_keys_and_modifiers_stay():
    obj = torus()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Wave")
    key.data[0].co.z += 1
    obj.modifiers.new("Subdivision", "SUBSURF")
    assert run() == {"FINISHED"}
    assert [k.name for k in obj.data.shape_keys.key_blocks] == ["Basis", "Wave"]
    assert [m.name for m in obj.modifiers] == ["Subdivision"]


def test_polygons_are_read_as_blender_gives_them():
    """The same numbers as one by one, whatever the types in which a version of Blender keeps them."""
    vertices = np.random.default_rng(1).normal(size=(9, 3))
    obj = mesh_object("Mixed", vertices, [(0, 1, 2), (2, 1, 3, 4), (4, 3, 5, 6, 7), (8, 4, 7)])
    polygons = module("scene.mesh_io").read_polygons(obj.data, np.eye(3))
    assert polygons.corner_vertices.tolist() == [loop.vertex_index for loop in obj.data.loops]
    assert polygons.face_offsets.tolist() == [p.loop_start for p in obj.data.polygons] + [15]
    assert np.abs(polygons.vertices - vertices).max() < 1e-6


def test_many_objects_give_few_messages(capfd):
    """One where all are told the same; one with their number where each is told something else."""
    objs = [mesh_object(f"Ring {k}", *torus_arrays(12, 8)) for k in range(12)]
    select(*objs)
    assert run() == {"FINISHED"}
    said = [line for line in capfd.readouterr().out.splitlines() if ": " in line]
    assert len(said) == 1 and said[0].startswith(f"Warning: {objs[0].name} and 11 more: To tile: ")
    in_short, different = module("results.write").in_short, [f"Box {k}: {k} faces left out" for k in range(9)]
    assert in_short(different[:8]) == different[:8] and in_short([]) == []
    assert in_short(different) == [
        "9 messages; the panel of each object has its own. The first: Box 0: 0 faces left out"
    ]
    assert in_short(["Box: no", "a plain sentence", "Ball: no"]) == ["Box and 1 more: no", "a plain sentence"]
