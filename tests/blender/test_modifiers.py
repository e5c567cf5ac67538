"""Meshes as their modifiers make them: mapped on demand, and a hint where there is nothing to map without."""

import bpy
import numpy as np
import pytest
from picked_faces import pick_faces
from scenes import (
    edge_mismatch,
    everything,
    grid_arrays,
    linked,
    mesh_object,
    pick,
    run,
    select,
    stored_report,
    torus,
    torus_arrays,
    uv,
)


def skin():
    """Two bones that only a modifier gives a skin."""
    obj = mesh_object("Bones", [(0, 0, 0), (0, 0, 1), (0, 1, 2)], [])
    obj.data.edges.add(2)
    for edge, ends in zip(obj.data.edges, [(0, 1), (1, 2)]):
        edge.vertices = ends
    obj.data.update()
    select(obj)
    obj.modifiers.new("Skin", "SKIN")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.skin_root_mark()
    bpy.ops.object.mode_set(mode="OBJECT")
    return obj


def half_grid():
    obj = mesh_object("Half", *grid_arrays())
    obj.data.materials.append(bpy.data.materials.new("Mine"))
    obj.modifiers.new("Mirror", "MIRROR")
    return obj


def with_modifiers(**options):
    return run(modifiers=True, **options)


def test_modifiers_that_move_vertices_leave_the_maps_on_the_mesh():
    obj = torus()
    obj.modifiers.new("Wave", "WAVE").height = 0.5
    bpy.context.scene.frame_set(20)
    run(forms=0)
    plain = uv(obj)
    assert with_modifiers(forms=0) == {"FINISHED"}
    assert list(bpy.data.objects) == [obj] and not np.array_equal(uv(obj), plain)
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = [tuple(v.co) for v in shown.data.vertices]
    applied = mesh_object("Applied", points, torus_arrays()[1])
    run(forms=0)
    assert np.array_equal(uv(applied), uv(obj))


def test_what_the_modifiers_make_becomes_an_object_in_the_place_of_the_first():
    obj = half_grid()
    obj.location = (1, 2, 3)
    assert with_modifiers() == {"FINISHED"}
    made = bpy.data.objects["Half Mapped"]
    assert stored_report(made)["components"][0]["faces"] == 72 == len(made.data.polygons)
    assert not obj.data.uv_layers and "holomorph_report" not in obj
    assert np.allclose(made.matrix_world, obj.matrix_world) and not made.modifiers
    assert obj.hide_get() and obj.hide_render and not made.hide_get() and not made.hide_render
    assert bpy.context.view_layer.objects.active == made and made.select_get() and not obj.select_get()
    assert list(made.data.materials) == list(obj.data.materials)


def test_a_second_run_replaces_the_object_and_leaves_no_mesh_behind():
    obj = half_grid()
    with_modifiers()
    obj.hide_set(False)
    select(obj)
    with_modifiers(density=2)
    assert sorted(bpy.data.objects.keys()) == ["Half", "Half Mapped"]
    assert sorted(bpy.data.meshes.keys()) == ["Half", "Half Mapped"]


def test_the_object_is_mapped_as_its_applied_mesh_is():
    obj = torus()
    obj.modifiers.new("Subdivision", "SUBSURF")
    with_modifiers()
    made = bpy.data.objects["Torus Mapped"]
    difference, forgiven = edge_mismatch(made.data, uv(made))
    assert len(made.data.polygons) == 4 * 288 and difference <= forgiven


def test_a_skin_is_pointed_to_and_mapped():
    obj = skin()
    before = everything(obj)
    with pytest.raises(RuntimeError, match="come from its modifiers .'Skin'.: switch With Modifiers on"):
        run()
    assert everything(obj) == before
    assert with_modifiers() == {"FINISHED"}
    assert stored_report(bpy.data.objects["Bones Mapped"])["components"][0]["genus"] == 0


def test_a_stack_that_leaves_nothing_is_refused():
    obj = torus()
    obj.vertex_groups.new(name="Nothing")
    mask = obj.modifiers.new("Mask", "MASK")
    mask.vertex_group = "Nothing"
    before = everything(obj)
    with pytest.raises(RuntimeError, match="its modifiers leave no faces; the first is 'Mask'"):
        with_modifiers()
    assert everything(obj) == before and list(bpy.data.objects) == [obj]


def three_sheets():
    """On one edge."""
    obj = mesh_object("Strip", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    for index, angle in enumerate((2, 4)):
        array = obj.modifiers.new(f"Array {index}", "ARRAY")
        array.count, array.use_relative_offset, array.use_object_offset = 2, False, True
        turned = bpy.data.objects.new(f"Turned {index}", None)
        turned.rotation_euler.x = angle / 2
        bpy.context.scene.collection.objects.link(turned)
        array.offset_object, array.use_merge_vertices = turned, True
    select(obj)
    return obj


def test_a_stack_that_makes_no_surface_is_cut():
    obj = three_sheets()
    assert with_modifiers() == {"FINISHED"} and obj.hide_get()
    (cut,) = stored_report(bpy.data.objects["Strip Mapped"])["repairs"]["cuts"]
    assert cut["reason"] == "many_faces"


def test_a_stack_without_area_is_refused_and_makes_no_object():
    obj = three_sheets()
    obj.scale = (1, 0, 0)
    bpy.context.view_layer.update()
    count = len(bpy.data.objects)
    with pytest.raises(RuntimeError, match="area"):
        with_modifiers()
    assert len(bpy.data.objects) == count and not obj.hide_get()


def test_a_modifier_without_its_target_does_nothing():
    obj = torus()
    obj.modifiers.new("Boolean", "BOOLEAN")
    assert with_modifiers() == {"FINISHED"}
    assert list(bpy.data.objects) == [obj] and obj.data.uv_layers


def test_modifiers_that_are_off_do_not_count():
    obj = half_grid()
    obj.modifiers[0].show_viewport = False
    with_modifiers()
    assert list(bpy.data.objects) == [obj]


def test_choices_on_the_mesh_are_refused_where_the_mesh_is_another_one():
    half_grid()
    with pytest.raises(RuntimeError, match="the selection is on the mesh itself"):
        with_modifiers(use_selection="POLES")
    with pytest.raises(RuntimeError, match="select poles and edges on the mesh itself"):
        bpy.ops.uv.holomorphic_tile(modifiers=True, direction="EDGES")


def test_in_edit_mode_the_mesh_itself_is_mapped():
    obj = half_grid()
    pick(obj, [24])
    with_modifiers()
    pick_faces(obj, range(18))
    with_modifiers()
    assert list(bpy.data.objects) == [obj] and stored_report(obj)["faces"] == 18


def test_seams_count_on_what_the_modifiers_make():
    obj = torus()
    obj.modifiers.new("Subdivision", "SUBSURF")
    obj.data.edges[40].use_seam = True  # does not cut it to a disk
    with_modifiers(cut_at_seams=True)
    assert stored_report(bpy.data.objects["Torus Mapped"])["components"][0]["not_followed"]


def test_a_linked_mesh_is_refused_with_its_modifiers_too(tmp_path):
    half_grid()
    select(linked(tmp_path))
    with pytest.raises(RuntimeError, match="make it local"):
        with_modifiers()
    assert len(bpy.data.objects) == 1


def test_a_tiling_of_what_the_modifiers_make():
    obj = torus()
    obj.modifiers.new("Subdivision", "SUBSURF")
    assert bpy.ops.uv.holomorphic_tile(tiles=30, modifiers=True) == {"FINISHED"}
    assert "tiling" in stored_report(bpy.data.objects["Torus Mapped"])["components"][0]


def test_two_objects_of_one_mesh_each_with_its_modifiers():
    first = half_grid()
    second = first.copy()
    bpy.context.scene.collection.objects.link(second)
    second.modifiers[0].use_axis = (False, True, False)
    select(first, second)
    with_modifiers()
    assert {"Half Mapped", "Half.001 Mapped"} <= set(bpy.data.objects.keys())
    assert list(bpy.context.view_layer.objects.selected)
