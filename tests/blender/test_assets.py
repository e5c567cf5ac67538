"""The textures' materials as assets."""

import bpy
import pytest
from loaded_addon import module
from scenes import torus

nodes, patterns, material = module("materials.nodes"), module("materials.patterns"), module("materials.material")


def marked():
    return [m for m in bpy.data.materials if m.asset_data is not None]


def test_there_is_an_asset_of_each_texture():
    assert bpy.ops.object.holomorphic_assets() == {"FINISHED"}
    assert {m[nodes.ASSET] for m in marked()} == set(patterns.TEXTURES)
    for made in marked():
        (uv,) = [node for node in made.node_tree.nodes if node.type == "UVMAP"]
        assert uv.uv_map == "Holomorphic" and not material.is_ours(made)
        assert "Seamless Tiling" in made.asset_data.description
        assert all(node.image.packed_file for node in made.node_tree.nodes if node.type == "TEX_IMAGE")


def test_those_that_are_there_are_not_made_again():
    bpy.ops.object.holomorphic_assets()
    first, *rest = marked()
    with pytest.raises(RuntimeError, match="already"):
        bpy.ops.object.holomorphic_assets()
    bpy.data.materials.remove(first)
    bpy.ops.object.holomorphic_assets()
    assert len(marked()) == len(patterns.TEXTURES) and set(rest) < set(marked())


def test_an_asset_is_the_users_material():
    """It is covered and brought back like any other, and can be chosen as a texture."""
    obj = torus()
    bpy.ops.object.holomorphic_assets()
    bricks = bpy.data.materials["Bricks on Tiling"]
    obj.data.materials.append(bricks)
    bpy.ops.uv.holomorphic_tile(texture="WEAVE", poles="COUNT", pole_count=0)
    bpy.ops.uv.holomorphic_restore_materials()
    assert obj.material_slots[0].material == bricks
    bpy.ops.uv.holomorphic_tile(texture="MATERIAL", source=bricks.name, poles="COUNT", pole_count=0)
    assert obj.material_slots[0].material.name == f"Holomorphic {bricks.name}"
    assert bricks.asset_data is not None and obj.material_slots[0].material.asset_data is None
