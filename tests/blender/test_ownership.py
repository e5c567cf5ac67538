"""What is the artist's stays: copies of our results."""

import bpy
import pytest
from conftest import module
from scenes import select, torus

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
