"""The presets of the tile operator: what they set, and where Blender shows them."""

import ast

import bpy
import pytest
from conftest import module
from scenes import stored_report, torus

presets = module("presets")
FILES = sorted(presets.FOLDER.glob("*.py"))


def values(path):
    """{property: value} that a preset sets on the operator."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    assigned = [node for node in body if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)]
    return {node.targets[0].attr: ast.literal_eval(node.value) for node in assigned}


def test_there_are_some_and_all_set_the_same():
    assert {"Scales", "Cloth", "Bricks", "Wood", "Planks", "Hexagons", "Numbered_Check"} == {p.stem for p in FILES}
    assert len({frozenset(values(path)) for path in FILES}) == 1


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_preset_is_accepted(path):
    obj = torus()
    assert bpy.ops.uv.holomorphic_tile(**values(path)) == {"FINISHED"}
    assert stored_report(obj)["dials"]["texture"] == values(path)["texture"]


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
    Context.active_operator = type("Operator", (), {"bl_idname": "UV_OT_holomorphic_tile"})
    presets._draw(Menu(), Context)
    assert drawn == [(str(presets.FOLDER), "script.execute_preset")]
