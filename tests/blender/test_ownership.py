"""What is the artist's stays: copies of our results, attributes with our names."""

import bpy
import pytest
from conftest import module
from scenes import everything, select, stored_report, torus

results = {name: module(name).OF for name in ("results.stand_in", "results.empties", "levels.level_objects")}


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
    return sorted(o.name for key in results.values() for o in bpy.data.objects if o.get(key) == obj.name)


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
