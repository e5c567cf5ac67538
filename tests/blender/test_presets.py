"""The presets of the operators: what they set, and where Blender shows them."""

import ast

import bpy
import pytest
from loaded_addon import module
from scenes import torus

presets = module("interface.menus")
FILES = {name: sorted((presets.FOLDER / name).glob("*.py")) for name in presets.NAMES}
EACH = [pytest.param(name, path, id=path.stem) for name, paths in FILES.items() for path in paths]


def values(path):
    """{property: value} that a preset sets on the operator."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    assigned = [node for node in body if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)]
    return {node.targets[0].attr: ast.literal_eval(node.value) for node in assigned}


def test_there_are_some_and_all_of_an_operator_set_the_same():
    maps, tile = ({path.stem for path in FILES[name]} for name in presets.NAMES)
    assert tile == {"Scales", "Cloth", "Bricks", "Wood", "Planks", "Hexagons", "Numbered_Check"}
    assert maps == {"Numbered_Check", "Scales_All_Over", "Balanced_with_All_Forms", "Map_and_Seams_Alone"}
    for paths in FILES.values():
        assert len({frozenset(values(path)) for path in paths}) == 1


@pytest.mark.parametrize(("name", "path"), EACH)
def test_a_preset_is_accepted(name, path):
    obj, wanted = torus(), values(path)
    room, operator = name.split(".")
    assert getattr(getattr(bpy.ops, room), operator)(**wanted) == {"FINISHED"}
    shown = [slot.material.name for slot in obj.material_slots]
    assert len(shown) == wanted["checker"] and all(wanted["texture"].title() in name for name in shown)


def test_blenders_menu_has_ours_for_our_operator_alone():
    drawn = []

    class Menu:
        preset_operator = "script.execute_preset"

        class layout:
            separator = staticmethod(lambda: None)

        def path_menu(self, folders, operator, **_options):
            drawn.extend((folder, operator) for folder in folders)

    class Context:
        active_operator = None

    presets._draw(Menu(), Context)
    Context.active_operator = type("Operator", (), {"bl_idname": "UV_OT_unwrap"})
    presets._draw(Menu(), Context)
    assert drawn == []
    for name in ("maps", "tile"):
        Context.active_operator = type("Operator", (), {"bl_idname": f"UV_OT_holomorphic_{name}"})
        presets._draw(Menu(), Context)
        assert drawn.pop() == (str(presets.FOLDER / f"uv.holomorphic_{name}"), "script.execute_preset")
