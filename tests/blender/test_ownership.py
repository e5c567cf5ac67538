"""What is the artist's stays: copies of our results, attributes with our names, objects that are out of sight."""

from contextlib import contextmanager

import bpy
import pytest
from loaded_addon import module
from scenes import duplicate, everything, linked, mesh_object, select, sphere_arrays, stored_report, torus

TAGS = (module("results.tags").RESULT_OF, module("results.tags").EMPTY_OF, module("levels.level_objects").OF)


def mapped(obj):
    """What its modifiers make, as an object of its own."""
    if not obj.modifiers:
        obj.modifiers.new("Finer", "SUBSURF")
    obj.hide_set(False)
    select(obj)
    assert bpy.ops.uv.holomorphic_maps(modifiers=True) == {"FINISHED"}


def levels(obj):
    select(obj)
    assert bpy.ops.object.holomorphic_levels(levels=1, hidden=False) == {"FINISHED"}


def poles(obj):
    select(obj)
    assert bpy.ops.uv.holomorphic_tile(tiles=20, poles="COUNT", pole_count=2, empties=True) == {"FINISHED"}


def made_for(obj):
    """Their names."""
    return sorted(o.name for key in TAGS for o in bpy.data.objects if o.get(key) == obj.name)


@pytest.mark.parametrize("make", [mapped, levels, poles])
@pytest.mark.parametrize("is_linked", [False, True])
def test_a_copy_of_what_was_made_stays(make, is_linked):
    obj = torus()
    make(obj)
    names = made_for(obj)
    select(bpy.data.objects[names[0]])
    bpy.ops.object.duplicate(linked=is_linked)
    (copy,) = bpy.context.selected_objects
    make(obj)
    assert made_for(obj) == sorted([*names, copy.name])
    copy.name = "Mine"
    make(obj)
    assert copy.name == "Mine" and made_for(obj) == sorted([*names, "Mine"])


@pytest.mark.parametrize("make", [mapped, levels])
def test_what_was_made_for_an_object_that_has_another_name_now_stays(make):
    first = torus()
    make(first)
    names = made_for(first)
    for name in names:
        bpy.data.objects[name]["made for"] = "First"
    first.name = "First"
    make(torus())
    assert sum("made for" in obj for obj in bpy.data.objects) == len(names)


def test_a_renamed_result_is_the_artists():
    obj = torus()
    mapped(obj)
    bpy.data.objects["Torus Mapped"].name = "Hero"
    mapped(obj)
    assert {"Hero", "Torus Mapped"} < {o.name for o in bpy.data.objects}


KINDS = [("POINT", "FLOAT"), ("FACE", "FLOAT_COLOR"), ("CORNER", "FLOAT2"), ("CORNER", "BYTE_COLOR"), ("EDGE", "INT")]


@pytest.mark.parametrize(("domain", "kind"), KINDS)
@pytest.mark.parametrize("are_slots_full", [False, True])
def test_an_attribute_with_the_name_of_our_map_stays(domain, kind, are_slots_full):
    obj = torus()
    for _ in range(8 * are_slots_full):
        obj.data.uv_layers.new(name="Own")
    obj.data.attributes.new("Holomorphic", kind, domain)
    before = everything(obj)
    for press in (bpy.ops.uv.holomorphic_maps, bpy.ops.uv.holomorphic_tile):
        assert press() == {"FINISHED"}
        (name, *_) = [entry["name"] for entry in stored_report(obj)["maps"]]
        assert name == "Holomorphic.001"
        covering = obj.material_slots[0].material.node_tree.nodes["Checker Map"]
        assert getattr(covering, "uv_map", "") == name or covering.attribute_name == name
    bpy.ops.uv.holomorphic_remove_maps()
    after = everything(obj)
    for found in (before, after):
        found["attributes"] = [each for each in found["attributes"] if each[0] == "Holomorphic"]
    assert after["attributes"] == before["attributes"] and after["maps"] == before["maps"]


@pytest.mark.parametrize("name", ["Holomorphic Shape", "Holomorphic Density"])
def test_an_attribute_of_another_kind_stays_where_nothing_is_stored(name):
    obj = torus()
    obj.data.attributes.new(name, "INT", "EDGE")
    bpy.ops.uv.holomorphic_maps()
    bpy.ops.uv.holomorphic_remove_maps()
    attribute = obj.data.attributes[name]
    assert (attribute.domain, attribute.data_type) == ("EDGE", "INT")


def stretched_pair():
    """Two objects with one mesh, its material on a slot, the second one in another scale."""
    first = torus("First")
    first.data.materials.append(bpy.data.materials.new("Own"))
    second = duplicate(first)
    second.name, second.scale = "Second", (1, 1, 3)
    select(first, second)
    return first, second


@pytest.mark.parametrize("are_both_selected", [True, False])
def test_objects_with_one_mesh_both_get_the_report(are_both_selected):
    first, second = stretched_pair()
    second.select_set(are_both_selected)
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"}
    of_first, of_second = stored_report(first), stored_report(second)
    assert (of_second.pop("scale_of"), of_second.pop("object"), of_first.pop("object")) == ("First", "Second", "First")
    assert of_first == of_second
    assert [obj.holomorph_map.made.whole for obj in (first, second)] == ["", "In the scale of First"]
    own = second.material_slots[0].material.name == "Own"
    assert own != are_both_selected and first.material_slots[0].material.name != "Own"


def test_a_duplicate_of_the_same_shape_gets_the_report_without_a_word():
    first, second = stretched_pair()
    second.scale, second.rotation_euler = (2, 2, -2), (1, 2, 3)
    bpy.context.view_layer.update()
    bpy.ops.uv.holomorphic_maps()
    assert "scale_of" not in stored_report(second) and stored_report(second)["object"] == "Second"


def test_a_forest_of_duplicates_has_one_sentence_and_a_bounded_file():
    first, second = stretched_pair()
    trees = [duplicate(second) for _ in range(120)]
    trees[-1]["holomorph_report"] = trees[-1].holomorph_map.made.map = "of an earlier map"
    (target,) = module("scene.targets").collect([first])
    assert target.note == "Second and 120 more have the same mesh in another scale; the scale of First is used"
    bpy.ops.uv.holomorphic_maps()
    assert sum("holomorph_report" in tree for tree in trees) == 99 and "holomorph_report" not in trees[-1]
    assert sum(tree.holomorph_map.made.map != "" for tree in trees) == 99 and not trees[-1].holomorph_map.made.map


def test_poles_are_dragged_on_the_object_whose_scale_counts():
    first, second = stretched_pair()
    bpy.ops.uv.holomorphic_tile(tiles=20, poles="COUNT", pole_count=2)
    select(second)
    with pytest.raises(RuntimeError, match="drag the points on First"):
        bpy.ops.uv.holomorphic_drag_poles(moves="0:7")
    select(first)
    assert bpy.ops.uv.holomorphic_drag_poles(moves="0:7") == {"FINISHED"}


def out_of_sight(how):
    """An object that is selected, in a collection of its own that is not seen."""
    obj, other = torus(), mesh_object("Ball", *sphere_arrays())
    collection = bpy.data.collections.new("Own")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    select(other, obj)
    setattr(bpy.context.view_layer.layer_collection.children["Own"], how, True)
    return obj, other


@pytest.mark.parametrize("how", ["exclude", "hide_viewport"])
def test_what_is_out_of_sight_is_left_alone(how):
    obj, other = out_of_sight(how)
    before = everything(obj)
    for press in (bpy.ops.uv.holomorphic_maps, bpy.ops.mesh.holomorphic_repair, bpy.ops.uv.holomorphic_heat):
        press()
    assert everything(obj) == before and other.data.uv_layers
    other.select_set(False)
    with pytest.raises(RuntimeError, match="Select a mesh"):
        bpy.ops.uv.holomorphic_maps()


def test_instances_are_told_how_to_become_meshes():
    obj, instance = torus(), bpy.data.objects.new("Instance", None)
    collection = bpy.data.collections.new("Own")
    collection.objects.link(obj)
    instance.instance_type, instance.instance_collection = "COLLECTION", collection
    bpy.context.scene.collection.objects.link(instance)
    select(instance)
    with pytest.raises(RuntimeError, match="Make Instances Real"):
        bpy.ops.uv.holomorphic_maps()


def overridden(tmp_path):
    """A library override of an object in another file."""
    torus("Linked")
    obj = linked(tmp_path).override_create(remap_local_usages=True)
    select(obj)
    return obj


def test_an_override_of_a_mesh_is_refused(tmp_path):
    obj = overridden(tmp_path)
    with pytest.raises(RuntimeError, match="linked from another file"):
        bpy.ops.uv.holomorphic_maps()
    obj.data.override_create(remap_local_usages=True)
    with pytest.raises(RuntimeError, match="library override"):
        bpy.ops.uv.holomorphic_maps()
    assert bpy.ops.mesh.holomorphic_repair() == {"CANCELLED"} and not obj.data.uv_layers


def test_an_override_with_a_mesh_of_this_file_is_mapped(tmp_path):
    obj = overridden(tmp_path)
    obj.data = obj.data.copy()
    assert bpy.ops.uv.holomorphic_maps() == {"FINISHED"} and stored_report(obj)["done"]
    path = str(tmp_path / "open.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert "Holomorphic" in bpy.data.objects["Linked", None].data.uv_layers


@contextmanager
def speaking(language):
    """The interface, and names of new data, in this language. Factory settings alone leave messages in it."""
    view, before = bpy.context.preferences.view, bpy.context.preferences.view.language
    try:
        view.language = language
    except TypeError:
        pytest.skip(f"this Blender has no {language}")
    view.use_translate_interface = view.use_translate_tooltips = view.use_translate_new_dataname = True
    yield
    view = bpy.context.preferences.view
    view.use_translate_interface = view.use_translate_tooltips = view.use_translate_new_dataname = False
    view.language = before


def written():
    """What tilings with two textures leave: material, its links, maps."""
    obj = torus()
    for texture in ("CHECKER", "BRICKS"):
        assert bpy.ops.uv.holomorphic_tile(texture=texture) == {"FINISHED"}
        material = obj.material_slots[0].material
        ends = [(k.from_node, k.to_node, k.from_socket.name, k.to_socket.name) for k in material.node_tree.links]
        links = [(one.bl_idname, other.bl_idname, *sockets) for one, other, *sockets in ends]
        yield material.name, links, everything(obj)["maps"], material.node_tree.nodes.active.bl_idname


@pytest.mark.parametrize("language", ["de_DE", "ja_JP", "fr_FR"])
def test_a_translated_interface_changes_nothing_that_is_written(language):
    expected = list(written())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with speaking(language):
        found = list(written())
        names = [node.name for node in bpy.data.materials[-1].node_tree.nodes]
    assert found == expected
    assert "Vector Math" not in names  # or the names of new data were not translated
    bpy.ops.wm.read_factory_settings(use_empty=True)
