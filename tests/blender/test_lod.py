"""Levels of detail of an object: what they are made of, where they stand, and that textures stay in place."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import (
    edge_mismatch,
    everything,
    mesh_io,
    mesh_object,
    polygon_arrays,
    run,
    select,
    sphere_arrays,
    torus,
    torus_arrays,
    two_parts,
    uv,
    uv_maps,
)

Values = module("compatibility").Values
FINE = {"around": 48, "across": 24}  # 2304 triangles


def make(**options):
    """The levels alone, in the object's place and in sight."""
    return bpy.ops.object.holomorphic_levels(**{"side_by_side": False, "hidden": False, **options})


def levels_of(name, first=1):
    """By number; level 0 is a copy of the object."""
    made = [o for o in bpy.data.objects if o.get("holomorph_levels_of") == name]
    found = [o for o in made if first == 0 or not o.name.endswith("_LOD0")]
    return sorted(found, key=lambda o: int(o.name.rsplit("_LOD", 1)[1].split(".")[0]))


def triangle_counts(name):
    return [len(o.data.polygons) for o in levels_of(name)]


def positions(obj):
    return mesh_io.read_values(module("compatibility").position_values(obj.data))


def at_vertices(obj, name="Holomorphic"):
    """{position: UVs of all corners there}, all bits."""
    corners, _ = polygon_arrays(obj.data)
    found = {}
    for place, value in zip(positions(obj)[corners].tolist(), uv_maps.read_map(obj.data, name).tolist()):
        found.setdefault(tuple(place), set()).add(tuple(value))
    return found


def test_levels_are_objects_in_a_collection_of_their_own():
    obj = torus(**FINE)
    assert make(levels=3) == {"FINISHED"}
    assert [o.name for o in levels_of("Torus")] == ["Torus_LOD1", "Torus_LOD2", "Torus_LOD3"]
    assert triangle_counts("Torus") == [576, 144, 36]
    collection = bpy.data.collections["Torus LODs"]
    assert set(collection.objects) == set(levels_of("Torus", 0))
    assert collection.name in bpy.context.scene.collection.children
    for level in levels_of("Torus"):
        assert np.allclose(level.matrix_world, obj.matrix_world)
        assert set(np.diff(polygon_arrays(level.data)[1])) == {3}
        assert not level.select_get()
    assert bpy.context.view_layer.objects.active == obj and obj.select_get()


def test_levels_stand_beside_the_object_where_it_is_shown():
    obj = torus(**FINE)
    scene = bpy.context.scene.collection
    for name in ("Excluded", "Shown"):
        collection = bpy.data.collections.new(name)
        scene.children.link(collection)
        collection.objects.link(obj)
    scene.objects.unlink(obj)
    layers = bpy.context.view_layer.layer_collection.children
    layers["Excluded"].exclude = True
    select(obj)
    make(levels=1)
    assert bpy.data.collections["Shown"].children.keys() == ["Torus LODs"]
    layers["Shown"].children["Torus LODs"].exclude = True
    make(levels=2)  # what the artist has put away is replaced all the same
    assert len(levels_of("Torus", 0)) == len(bpy.data.collections["Torus LODs"].objects) == 3


def test_the_number_of_levels_and_their_sizes():
    torus(**FINE)
    make(levels=2, ratio=0.5)
    assert triangle_counts("Torus") == [1152, 576]
    make(levels=6)
    assert triangle_counts("Torus")[:3] == [576, 144, 36] and triangle_counts("Torus")[-1] <= 20
    assert triangle_counts("Torus") == sorted(set(triangle_counts("Torus")), reverse=True)


def test_the_map_is_made_first_and_is_the_operators_own():
    obj = torus(**FINE)
    make(levels=1)
    made = uv(obj)
    assert [layer.name for layer in obj.data.uv_layers] == ["Holomorphic"]
    assert obj.data.uv_layers.active.name == "Holomorphic"
    assert "holomorph_report" in obj and "holomorph_report" not in levels_of("Torus")[0]
    run(forms=0, checker=False)
    assert np.array_equal(uv(obj), made)


def test_every_vertex_keeps_its_uvs_and_every_edge_fits():
    obj = torus(**FINE)
    run()
    fine = {name: at_vertices(obj, name) for name in ("Holomorphic", "Holomorphic 1")}
    make(levels=3)
    for level in levels_of("Torus"):
        assert [layer.name for layer in level.data.uv_layers] == ["Holomorphic", "Holomorphic 1"]
        assert level.data.uv_layers.active.name == "Holomorphic"
        for name, places in fine.items():
            coarse = at_vertices(level, name)
            kept = [bool(values & places[place]) for place, values in coarse.items()]
            assert np.mean(kept) == 1
            difference, forgiven = edge_mismatch(level.data, uv(level, name))
            assert difference <= forgiven


def test_maps_with_dials_and_of_the_artist_are_transferred_as_they_are():
    obj = torus(**FINE)
    artist = obj.data.uv_layers.new(name="Artist").name
    flat = positions(obj)[polygon_arrays(obj.data)[0]][:, :2]
    mesh_io.write_values(module("compatibility").uv_values(obj.data.uv_layers[artist]), flat)
    run(density=3.0, rotation=0.4)
    obj.data.uv_layers.active = obj.data.uv_layers[artist]
    fine = at_vertices(obj)
    make(levels=2)
    for level in levels_of("Torus"):
        assert level.data.uv_layers.active.name == artist
        assert level.data.uv_layers["Holomorphic"].active_render
        corners = polygon_arrays(level.data)[0]
        assert np.array_equal(uv_maps.read_map(level.data, artist), positions(level)[corners][:, :2])
        assert all(values & fine[place] for place, values in at_vertices(level).items())


def test_materials_smoothness_marks_and_attributes_stay():
    obj = torus(**FINE)
    mesh = obj.data
    for name in ("Red", "Green"):
        mesh.materials.append(bpy.data.materials.new(name))
    x = positions(obj)[:, 0]
    of_face = (x[polygon_arrays(mesh)[0]].reshape(-1, 4).mean(axis=1) > 0).astype(np.int32)
    mesh_io.write_values(Values(mesh.polygons, "material_index", np.int32), of_face)
    mesh_io.write_values(Values(mesh.polygons, "use_smooth", bool), of_face == 1)
    around = np.stack([np.arange(48) * 24, np.roll(np.arange(48) * 24, -1)], axis=1)  # the outer circle
    mesh_io.mark_edges(mesh, "use_edge_sharp", around)
    mesh.attributes.new("Height", "FLOAT", "POINT")
    mesh_io.write_values(Values(mesh.attributes["Height"].data, "value", np.float32), x)
    mesh.attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    colours = np.repeat(x[polygon_arrays(mesh)[0]][:, None], 4, axis=1).astype(np.float32)
    mesh_io.write_values(Values(mesh.attributes["Paint"].data, "color", np.float32, 4), colours)
    make(levels=2)
    for level in levels_of("Torus"):
        data = level.data
        x = positions(level)[:, 0]
        assert [slot.material.name for slot in level.material_slots] == ["Red", "Green"]
        face = mesh_io.read_values(Values(data.polygons, "material_index", np.int32))
        smooth = mesh_io.read_values(Values(data.polygons, "use_smooth", bool))
        middle = x[polygon_arrays(data)[0]].reshape(-1, 3).mean(axis=1)
        assert np.array_equal(smooth, face == 1)
        assert np.mean((middle > 0) == (face == 1)) > 0.85
        assert np.array_equal(mesh_io.read_values(Values(data.attributes["Height"].data, "value", np.float32)), x)
        paint = mesh_io.read_values(Values(data.attributes["Paint"].data, "color", np.float32, 4))
        assert np.mean(paint[:, 0] == x[polygon_arrays(data)[0]]) > 0.9
        sharp = mesh_io.marked_edges(data, "use_edge_sharp")
        degree = np.bincount(sharp.ravel())
        assert len(sharp) >= 3 and set(degree[degree > 0]) == {2}  # still a circle


def test_weights_modifiers_parent_and_properties_stay():
    obj = torus(**FINE)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location = (1, 2, 3)
    obj.parent = parent
    obj.location.x = 5
    obj["Own"] = 7
    obj.modifiers.new("Wave", "WAVE").height = 3.0  # what modifiers do to the vertices does not matter
    group = obj.vertex_groups.new(name="Half")
    half = np.flatnonzero(positions(obj)[:, 0] > 0)
    group.add(half.tolist(), 0.75, "REPLACE")
    select(obj)
    make(levels=2)
    for level in levels_of("Torus"):
        assert level.parent == parent and level["Own"] == 7
        assert [m.name for m in level.modifiers] == ["Wave"]
        assert np.allclose(level.matrix_world, obj.matrix_world)
        right = positions(level)[:, 0] > 0
        weights = [[(g.group, round(g.weight, 4)) for g in v.groups if g.weight] for v in level.data.vertices]
        assert weights == [[(0, 0.75)] if inside else [] for inside in right]
    assert "Holomorph Weights" not in bpy.data.objects


def test_side_by_side_in_the_world():
    obj = torus(**FINE)
    obj.rotation_euler = (0.3, 0.2, 1.0)
    obj.scale = (1.0, 2.0, 0.5)
    select(obj)
    make(levels=3, side_by_side=True)
    span = mesh_io.world_points(obj)[:, 0]
    for level in levels_of("Torus"):
        low, high = mesh_io.world_points(level)[:, 0].min(), mesh_io.world_points(level)[:, 0].max()
        assert low > span.max()
        span = np.array([low, high])
        assert np.allclose(level.matrix_world.to_3x3(), obj.matrix_world.to_3x3(), atol=1e-6)


def test_scale_counts_and_positions_do_not_change():
    """Flattened by its scale, the torus loses other vertices; those that are left are where they were."""
    obj = torus(**FINE)
    make(levels=1)
    (round_level,) = levels_of("Torus")
    places = {tuple(p) for p in positions(obj).tolist()}
    kept = {tuple(p) for p in positions(round_level).tolist()}
    flat = torus("Flat", **FINE)
    flat.scale.z = 0.01
    select(flat)
    make(levels=1)
    (flat_level,) = levels_of("Flat")
    other = {tuple(p) for p in positions(flat_level).tolist()}
    assert kept < places and other < places and kept != other


def test_several_parts_and_a_sphere_beside_a_torus():
    obj = two_parts("Both", torus_arrays(**FINE), sphere_arrays())
    make(levels=2)
    triangles = 2304 + len(sphere_arrays()[1])
    assert triangle_counts("Both") == [triangles // 4, triangles // 16 // 2 * 2]
    for level in levels_of("Both"):
        assert np.ptp(positions(level)[:, 2]) > 3  # both parts are left
        assert level.data.uv_layers.active.name == obj.data.uv_layers.active.name == "Holomorphic"


def test_a_second_run_replaces_the_levels_and_nothing_else():
    obj = torus(**FINE)
    other = torus("Other", **FINE)
    make(levels=2)
    select(obj)
    make(levels=2)
    others = [(o.name, o.data.name) for o in levels_of("Other")]
    meshes = len(bpy.data.meshes)
    before = everything(obj)
    make(levels=2)
    assert [o.name for o in levels_of("Torus")] == ["Torus_LOD1", "Torus_LOD2"]
    assert [c.name for c in bpy.data.collections] == ["Other LODs", "Torus LODs"]
    assert [(o.name, o.data.name) for o in levels_of("Other")] == others
    assert len(bpy.data.meshes) == meshes
    assert everything(obj) == before and other.name == "Other"


def test_levels_of_levels():
    torus(**FINE)
    make(levels=2)
    select(bpy.data.objects["Torus_LOD1"])
    make(levels=1)
    assert triangle_counts("Torus_LOD1") == [144]
    assert len(levels_of("Torus")) == 2


def test_one_undo_step():
    obj = torus(**FINE)
    bpy.ops.ed.undo_push(message="before")
    make(levels=2)
    bpy.ops.ed.undo_push(message="after")
    assert len(levels_of("Torus")) == 2
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Torus"]
    assert not levels_of("Torus") and "Torus LODs" not in bpy.data.collections and not obj.data.uv_layers


def refused(words, **options):
    objects, collections = set(bpy.data.objects.keys()), set(bpy.data.collections.keys())
    obj = bpy.context.view_layer.objects.active
    before = everything(obj)
    with pytest.raises(RuntimeError, match=words):
        make(**options)
    assert set(bpy.data.objects.keys()) == objects and set(bpy.data.collections.keys()) == collections
    assert everything(obj) == before


def test_what_is_refused_is_left_as_it_is():
    mesh_object("Bad", *(lambda v, f: (v * np.nan, f))(*torus_arrays()))
    refused("Bad: vertex 0 has a coordinate that is not a number")
    vertices, faces = torus_arrays()
    mesh_object("Flat", vertices * (1, 0, 0), faces)
    refused("Flat: ")
    mesh_object("Nothing", [(0, 0, 0), (1, 0, 0)], [])
    refused("Nothing: ")


def test_without_any_map_nothing_is_made(monkeypatch):
    structures = module("solving.jobs").structures

    def skipped(part, *_):
        return structures.PartStructure(part, None, "the surface is strange")

    monkeypatch.setattr(structures, "_structure_of_part", skipped)
    obj = torus(**FINE)
    refused("Torus: there is no UV map, and none could be made: the surface is strange")
    obj.data.uv_layers.new(name="Artist")
    make(levels=2)  # there is a map to carry
    assert [layer.name for layer in levels_of("Torus")[1].data.uv_layers] == ["Artist"]


def test_too_little_memory_is_a_sentence(monkeypatch):
    def too_large(*_):
        raise MemoryError("there is not enough memory for a mesh of this size")

    torus(**FINE)
    monkeypatch.setattr(module("solving.jobs"), "solve", too_large)
    refused("Torus: there is not enough memory for a mesh of this size")


def test_an_irreducible_mesh_has_no_levels():
    """Császár's torus: 7 vertices, 14 triangles, and no edge that can be collapsed."""
    points = [[3, -3, 0], [-3, 3, 0], [-3, -3, 1], [3, 3, 1], [-1, -2, 3], [1, 2, 3], [0, 0, 15]]
    i = np.arange(7)
    triples = np.concatenate([np.stack([i, i + 1, i + 3], axis=1), np.stack([i, i + 3, i + 2], axis=1)]) % 7
    mesh_object("Csaszar", points, triples)
    refused("Csaszar: it cannot be made coarser")


def test_only_in_object_mode_with_an_active_mesh():
    torus(**FINE)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.holomorphic_levels.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.object.holomorphic_levels.poll()
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    select(empty)
    assert not bpy.ops.object.holomorphic_levels.poll()


def test_cancelling_ends_the_work_with_nothing_made():
    obj = torus(**FINE)
    source = module("levels.level_objects").Source(obj)
    work = source.work(module("levels.levels").LevelOptions(), lambda _fraction: work.cancel())
    work.start()
    work.wait()
    assert isinstance(work.error, module("native").load().Cancelled) and not work.levels
    seen = []
    work = source.work(module("levels.levels").LevelOptions(), seen.append)
    work.run()
    assert len(work.levels) == 4 and seen == sorted(seen)
    assert source.problem(work, time_has_passed=True) == ""
    obj.data.vertices[0].co.x += 1
    assert "it changed" in source.problem(work, time_has_passed=True)


def test_levels_come_hidden_and_beside_with_the_names_that_engines_know():
    obj = torus(**FINE)
    assert bpy.ops.object.holomorphic_levels(levels=2) == {"FINISHED"}
    made = levels_of("Torus", 0)
    assert [o.name for o in made] == ["Torus_LOD0", "Torus_LOD1", "Torus_LOD2"]
    assert all(o.hide_get() and o.hide_render for o in made) and not obj.hide_get() and not obj.hide_render
    places = [o.matrix_world.translation.x for o in made]
    width = np.ptp(positions(obj)[:, 0])
    assert places[0] > width and np.diff(places).min() > width
    assert made[0].data != obj.data and np.array_equal(uv(made[0]), uv(obj))
    assert bpy.context.view_layer.objects.active == obj and obj.select_get()


def test_an_object_that_is_level_0_itself_is_not_copied():
    torus("Mug_LOD0", **FINE)
    bpy.ops.object.holomorphic_levels(levels=2)
    assert [o.name for o in levels_of("Mug_LOD0")] == ["Mug_LOD1", "Mug_LOD2"]
    bpy.ops.object.holomorphic_levels(levels=1)
    assert [o.name for o in levels_of("Mug_LOD0")] == ["Mug_LOD1"]


def test_hidden_levels_are_replaced_and_leave_no_mesh():
    torus(**FINE)
    for _ in range(2):
        bpy.ops.object.holomorphic_levels(levels=1)
    assert sorted(bpy.data.meshes.keys()) == ["Torus", "Torus_LOD0", "Torus_LOD1"]
