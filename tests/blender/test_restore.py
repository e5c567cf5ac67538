"""Restore Materials and Remove Maps: what was shown before comes back, on all objects with the same mesh."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from picked_faces import add_own_map
from scenes import duplicate, everything, linked, mesh_io, run, select, torus, uv


def textured():
    """An object with two maps, one of them for renders, and a slot of each kind."""
    obj = torus()
    for name in ("First", "Second", "Third"):
        add_own_map(obj, name)
    obj.data.uv_layers.active = obj.data.uv_layers["Second"]
    obj.data.uv_layers["First"].active_render = True
    for name in ("Of Mesh", "Hidden", "Empty"):
        obj.data.materials.append(bpy.data.materials.new(name))
    obj.material_slots[1].link = "OBJECT"
    obj.material_slots[1].material = bpy.data.materials.new("Of Object")
    obj.material_slots[2].link = "OBJECT"
    obj.material_slots[2].material = None
    return obj


def shown(obj):
    layers = obj.data.uv_layers
    rendered = next(layer.name for layer in layers if layer.active_render)
    return layers.active.name, rendered, [(slot.link, slot.material) for slot in obj.material_slots]


def restore():
    return bpy.ops.uv.holomorphic_restore_materials()


@pytest.mark.parametrize("press", [run, bpy.ops.uv.holomorphic_tile], ids=["maps", "tile"])
def test_materials_and_both_active_maps_come_back(press):
    obj = textured()
    before = shown(obj)
    for _ in range(2):  # a second run must not take ours for the artist's
        press()
        assert shown(obj)[:2] == ("Holomorphic", "Holomorphic") and shown(obj)[2] != before[2]
    assert restore() == {"FINISHED"}
    assert shown(obj) == before
    assert "Holomorphic" in obj.data.uv_layers and restore() == {"CANCELLED"}


def test_without_a_checker_the_active_map_comes_back():
    obj = textured()
    before = shown(obj)
    run(checker=False)
    assert module("results.restore").is_possible(obj) and restore() == {"FINISHED"}
    assert shown(obj) == before


@pytest.mark.parametrize("with_slots", [True, False])
def test_a_linked_duplicate_restores_all_objects_with_its_mesh(with_slots):
    obj = textured()
    if not with_slots:
        obj.data.materials.clear()
    copy = duplicate(obj)
    before = shown(obj), shown(copy)
    select(obj)
    run()
    select(copy)
    assert restore() == {"FINISHED"}
    assert (shown(obj), shown(copy)) == before


def test_a_map_that_became_active_meanwhile_is_the_one_that_comes_back():
    obj = textured()
    run()
    obj.data.uv_layers.active = obj.data.uv_layers["Third"]
    run()
    restore()
    assert shown(obj)[:2] == ("Third", "First")


def test_a_map_that_was_renamed_is_left_alone():
    obj = textured()
    run()
    obj.data.uv_layers["Second"].name = "Renamed"
    assert restore() == {"FINISHED"}
    assert shown(obj)[:2] == ("Holomorphic", "First")


def test_faces_keep_their_numbers_of_slots_that_are_not_there():
    obj = torus()
    numbers = module("compatibility").Values(obj.data.polygons, "material_index", np.int32)
    before = np.arange(288, dtype=np.int32) % 3
    mesh_io.write_values(numbers, before)
    run()
    assert len(obj.material_slots) == 1 and restore() == {"FINISHED"}
    numbers = numbers._replace(elements=obj.data.polygons)
    assert not obj.material_slots and np.array_equal(mesh_io.read_values(numbers), before)


def test_restoring_in_edit_mode():
    obj = textured()
    before = shown(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    run()
    assert restore() == {"FINISHED"} and obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert shown(obj) == before


def test_removing_leaves_nothing_of_ours():
    obj = textured()
    before = everything(obj)
    run(shape=True)
    bpy.ops.uv.holomorphic_tile(empties=True)
    run()
    assert bpy.ops.uv.holomorphic_remove_maps() == {"FINISHED"}
    assert everything(obj) == before and list(bpy.data.objects) == [obj]
    assert bpy.ops.uv.holomorphic_remove_maps() == {"CANCELLED"}


def test_removing_on_a_duplicate_removes_the_report_of_both():
    obj = textured()
    before = everything(obj)
    copy = duplicate(obj)
    select(obj)
    run()
    select(copy)
    assert bpy.ops.uv.holomorphic_remove_maps() == {"FINISHED"}
    assert everything(obj) == before and everything(copy) == before


def test_removing_in_edit_mode_and_attributes_too():
    obj = torus()
    for index in range(8):
        add_own_map(obj, f"Own {index}")
    for mode in ("EDIT", "OBJECT"):  # Blender's own attributes are then in the order of edit mode
        bpy.ops.object.mode_set(mode=mode)
    before = everything(obj)
    run()
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.uv.holomorphic_remove_maps() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert everything(obj) == before


def test_removing_follows_with_the_heat_attributes():
    obj = textured()
    bpy.ops.uv.holomorphic_heat()
    before = np.array([v.value for v in obj.data.attributes["Holomorphic Density"].data])
    run()
    assert uv(obj).any()
    bpy.ops.uv.holomorphic_remove_maps()
    assert np.array_equal([v.value for v in obj.data.attributes["Holomorphic Density"].data], before)


def test_a_linked_mesh_is_left_alone(tmp_path):
    textured()
    run()
    obj = linked(tmp_path)
    select(obj)
    before = everything(obj)
    assert bpy.ops.uv.holomorphic_remove_maps() == {"CANCELLED"} and restore() == {"CANCELLED"}
    assert everything(obj) == before
