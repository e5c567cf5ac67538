"""The presets of the dials: what they set, and that the map is made of them."""

import ast

import bpy
import pytest
from loaded_addon import module
from scenes import select, stored_report, torus

presets, stored_dials = module("interface.menus"), module("scene.stored_dials")
FILES = sorted(presets.FOLDER.glob("*.py"))
NAMES = {"Automatic", "Scales", "Cloth", "Bricks", "Wood", "Planks", "Hexagons", "Numbered_Check"}


def values(path):
    """{dial: value} that a preset sets."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    assigned = [node for node in body if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)]
    return {node.targets[0].attr: ast.literal_eval(node.value) for node in assigned}


def test_there_are_some_and_all_set_the_same():
    assert {path.stem for path in FILES} == NAMES
    assert len({frozenset(values(path)) for path in FILES}) == 1


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_preset_sets_dials_and_makes_their_map(path):
    obj, wanted = torus(), values(path)
    assert bpy.ops.uv.holomorphic_preset(filepath=str(path)) == {"FINISHED"}
    now = stored_dials.of(obj)
    assert {name: now[name] for name in wanted} == wanted
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
