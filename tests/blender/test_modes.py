"""Modes: operators work on what is sculpted, painted or edited, and return to the mode; or say where to go."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from picked_faces import pick_faces
from scenes import everything, mesh_io, mesh_object, pick, select, sphere_arrays, stored_report, torus, uv

PAINTING = ("SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "PARTICLE_EDIT")
compatibility, image_io = module("compatibility"), module("scene.image_io")


def enter(mode, obj):
    if mode == "PARTICLE_EDIT":
        obj.modifiers.new("Hair", "PARTICLE_SYSTEM")
        obj.particle_systems[0].settings.type = "HAIR"
    bpy.ops.object.mode_set(mode=mode)


def twice_mapped():
    """An object with a loose vertex and a map, selected with another, which has a map as well."""
    other, obj = torus("Other"), torus()
    obj.data.vertices.add(1)
    obj.data.update()
    for each in (other, obj):
        select(each)
        bpy.ops.uv.holomorphic_maps(main="BALANCED")
    select(obj, other)
    return obj, other


def symmetric():
    """Once it is there: an image that does not look the same after the turns of its map."""
    made = bpy.data.images.new("Half", 8, 8)
    image_io.write_pixels(made, np.tile(np.linspace(0, 1, 8)[:, None, None], (1, 8, 4)))
    bpy.ops.uv.holomorphic_tile(texture="IMAGE", source="Half", turns="QUARTER")
    return bpy.ops.uv.holomorphic_make_symmetric()


OPERATORS = {
    "maps": lambda: bpy.ops.uv.holomorphic_maps(),
    "islands": lambda: bpy.ops.uv.holomorphic_islands(hard_edges=0.3),
    "tile": lambda: bpy.ops.uv.holomorphic_tile(tiles=20),
    "heat": lambda: bpy.ops.uv.holomorphic_heat(),
    "symmetric": lambda: symmetric(),
    "restore": lambda: bpy.ops.uv.holomorphic_restore_materials(),
    "remove": lambda: bpy.ops.uv.holomorphic_remove_maps(),
    "get": lambda: bpy.ops.uv.holomorphic_texels_get(),
    "set": lambda: bpy.ops.uv.holomorphic_texels_set(texels=100),
    "repair": lambda: bpy.ops.mesh.holomorphic_repair(),
    "levels": lambda: bpy.ops.object.holomorphic_levels(levels=1),
}


@pytest.mark.parametrize("name", OPERATORS)
@pytest.mark.parametrize("mode", PAINTING)
def test_an_operator_works_while_painting_and_returns(mode, name):
    obj, other = twice_mapped()
    enter(mode, obj)
    assert OPERATORS[name]() == {"FINISHED"}
    assert obj.mode == mode and other.mode == "OBJECT"
    assert bpy.context.view_layer.objects.active == obj and set(bpy.context.selected_objects) == {obj, other}


def test_what_is_sculpted_is_mapped_not_what_is_selected_beside_it():
    obj, other = torus(), torus("Other")
    select(obj, other)
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.uv.holomorphic_maps()
    assert obj.data.uv_layers and not other.data.uv_layers


def test_a_map_while_sculpting_is_that_of_object_mode():
    obj = torus()
    bpy.ops.uv.holomorphic_maps()
    expected = uv(obj)
    bpy.ops.uv.holomorphic_remove_maps()
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.uv.holomorphic_maps()
    assert np.array_equal(uv(obj), expected)


@pytest.mark.parametrize("mode", ["SCULPT", "EDIT"])
def test_shape_keys_stay_in_other_modes(mode):
    obj = torus()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    key.data[3].co.z += 1
    obj.active_shape_key_index = 1
    before = [tuple(point.co) for point in key.data], everything(obj)["positions"]
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    key = obj.data.shape_keys.key_blocks["Key"]
    assert ([tuple(point.co) for point in key.data], everything(obj)["positions"]) == before


def test_the_armature_stays_in_pose_mode_while_weights_are_painted():
    obj, armature = torus(), bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    select(armature, obj)
    bpy.ops.object.mode_set(mode="POSE")
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
    assert bpy.ops.uv.holomorphic_tile(tiles=20) == {"FINISHED"}
    assert (armature.mode, obj.mode) == ("POSE", "WEIGHT_PAINT")


def test_dyntopo_is_told_to_be_turned_off():
    obj = torus()
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.sculpt.dynamic_topology_toggle()
    with pytest.raises(RuntimeError, match="Turn Dyntopo off"):
        bpy.ops.uv.holomorphic_maps()
    assert obj.use_dynamic_topology_sculpting and not obj.data.uv_layers


def test_modes_of_other_things_are_told_where_to_go():
    obj, armature = torus(), bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    select(armature, obj)
    bpy.ops.object.mode_set(mode="POSE")
    with pytest.raises(RuntimeError, match="Switch to Object Mode or Edit Mode"):
        bpy.ops.uv.holomorphic_maps()


@pytest.mark.parametrize(
    ("operator", "options"),
    [("holomorphic_select_bad", {"kinds": {"LOOSE"}}), ("holomorphic_select_stretched", {"size": 1.0})],
)
def test_elements_of_what_is_sculpted_are_selected_in_edit_mode(operator, options):
    obj, _ = twice_mapped()
    bpy.ops.object.mode_set(mode="SCULPT")
    assert getattr(bpy.ops.mesh, operator)(**options) == {"FINISHED"}
    assert obj.mode == "EDIT"


def test_modifiers_count_in_object_mode_alone():
    obj = torus()
    obj.modifiers.new("Finer", "SUBSURF")
    bpy.ops.object.mode_set(mode="SCULPT")
    assert bpy.ops.uv.holomorphic_maps(modifiers=True) == {"FINISHED"}
    assert obj.data.uv_layers and list(bpy.data.objects) == [obj] and obj.mode == "SCULPT"


def test_an_object_that_is_edited_while_another_is_active():
    """As the Outliner makes it another one, without Lock Object Modes."""
    obj = torus()
    bpy.ops.object.mode_set(mode="EDIT")
    other = mesh_object("Other", *sphere_arrays())
    select(obj)
    bpy.context.view_layer.objects.active = other
    assert bpy.context.mode == "OBJECT" and obj.mode == "EDIT"
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    assert obj.mode == "EDIT" and other.mode == "OBJECT" and bpy.context.view_layer.objects.active == other
    assert obj.data.uv_layers and not other.data.uv_layers


def edited_elsewhere():
    """An object whose mesh is edited in another scene."""
    obj, scene, window = torus(), bpy.context.scene, bpy.context.window
    elsewhere = bpy.data.scenes.new("Elsewhere")
    other = obj.copy()
    elsewhere.collection.objects.link(other)
    window.scene = elsewhere
    elsewhere.view_layers[0].objects.active = other
    bpy.ops.object.mode_set(mode="EDIT")
    window.scene = scene
    return obj


@pytest.mark.parametrize("name", ["maps", "tile", "levels"])
def test_a_mesh_that_is_edited_in_another_scene_is_refused(name):
    obj = edited_elsewhere()
    before = everything(obj)
    with pytest.raises(RuntimeError, match="edited in another scene"):
        OPERATORS[name]()
    assert everything(obj) == before


@pytest.mark.parametrize("name", ["restore", "remove", "get", "repair"])
def test_no_tool_touches_a_mesh_that_is_edited_in_another_scene(name):
    obj = edited_elsewhere()
    before = everything(obj)
    assert OPERATORS[name]() == {"CANCELLED"} and everything(obj) == before


def test_hidden_faces_are_told_where_there_are_no_others():
    obj = torus()
    pick(obj, range(3))
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.hide()
    with pytest.raises(RuntimeError, match="all its faces are hidden"):
        bpy.ops.uv.holomorphic_maps()
    assert obj.mode == "EDIT" and not obj.data.uv_layers


@pytest.mark.parametrize("name", ["maps", "tile", "islands"])
def test_the_upper_faces_of_a_head_get_a_map(name):
    """A selection of several pieces: brows, ears and a cap."""
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    upper = [polygon.index for polygon in obj.data.polygons if polygon.center.z > 0.3]
    pick_faces(obj, upper)
    assert OPERATORS[name]() == {"FINISHED"} and obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert stored_report(obj)["faces"] == len(upper)
    corners = mesh_io.read_polygons(obj.data, np.eye(3))
    measured = module("native").load().distortion.measure(corners, uv(obj).astype(np.float32))
    assert np.isfinite(measured.angle[upper]).all() and (np.abs(measured.density[upper]) < 20).all()
