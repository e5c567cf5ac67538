"""The presets of the dials: what they set, and that the map is made of them."""

import bpy
import pytest
from loaded_addon import module
from scenes import select, stored_report, torus

presets, stored_dials = module("interface.menus"), module("scene.stored_dials")


@pytest.mark.parametrize("name", presets.PRESETS)
def test_a_preset_sets_dials_and_makes_their_map(name):
    obj, wanted = torus(), presets.USUAL | presets.PRESETS[name]
    assert bpy.ops.uv.holomorphic_preset(preset=name) == {"FINISHED"}
    now = stored_dials.of(obj)
    assert {dial: now[dial] for dial in wanted} == wanted
    assert stored_report(obj)["dials"]["stored"] == now
    shown = [slot.material.name for slot in obj.material_slots]
    assert len(shown) == wanted["checker"] and all(wanted["texture"].title() in name for name in shown)


def test_a_preset_of_the_users_holds_every_dial_that_any_object_has(tmp_path, monkeypatch):
    obj, other = torus(), torus("Other")
    select(obj)
    obj.holomorph_map.evenness, obj.holomorph_map.texture = 0.25, "BRICKS"
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_arguments, **_options: str(tmp_path))
    assert bpy.ops.uv.holomorphic_preset_add(name="Mine") == {"FINISHED"}
    (path,) = tmp_path.rglob("*.py")
    select(other)
    assert bpy.ops.uv.holomorphic_preset(filepath=str(path)) == {"FINISHED"}
    assert stored_dials.of(other) == stored_dials.of(obj)
