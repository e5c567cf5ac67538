"""Where the cut of a seamless tiling runs is not seen in a picture."""

import sys

import bpy
import numpy as np
import pytest
from repository import ROOT
from scenes import torus, uv

sys.path.insert(0, str(ROOT / "docs"))
import preview_scene

SIZE = 160
STEP = 1 / 255  # part of a channel


def picture(obj, path):
    preview_scene.render([obj], str(path), SIZE, 4)
    image = bpy.data.images.load(str(path))
    values = np.empty(4 * SIZE * SIZE, np.float32)
    image.pixels.foreach_get(values)
    return values


def glow(obj):
    """The texture alone, without lights, whose random paths differ where a colour differs in its last bit."""
    tree = obj.material_slots[0].material.node_tree
    shader = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(shader.inputs["Base Color"].links[0].from_socket, emission.inputs["Color"])
    for output in (n for n in tree.nodes if n.type == "OUTPUT_MATERIAL"):
        tree.links.new(emission.outputs["Emission"], output.inputs["Surface"])


def shift_random_faces(obj, by):
    """The cut now runs around each of them."""
    sizes = np.empty(len(obj.data.polygons), np.int32)
    obj.data.polygons.foreach_get("loop_total", sizes)
    chosen = np.repeat(np.random.default_rng(1).random(len(sizes)) < 0.5, sizes)
    moved = (uv(obj) + chosen[:, None] * np.asarray(by)).astype(np.float32)
    obj.data.uv_layers["Holomorphic"].data.foreach_set("uv", moved.ravel())


@pytest.mark.parametrize(("by", "seen"), [((3, -2), False), ((0.5, 0.25), True)], ids=["whole", "part"])
def test_a_cut_elsewhere(by, seen, tmp_path):
    obj = torus()
    assert bpy.ops.uv.holomorphic_tile(tiles=60, texture="BRICKS") == {"FINISHED"}
    glow(obj)
    before = picture(obj, tmp_path / "before.png")
    shift_random_faces(obj, by)
    difference = np.abs(picture(obj, tmp_path / "after.png") - before).max()
    assert (difference > 20 * STEP) if seen else (difference < 1.5 * STEP)
