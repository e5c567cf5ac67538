"""Each file of blend_examples/seamless: what an artist sees who opens it, without pressing anything."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from repository import ROOT
from scenes import edge_jumps, open_example, stored_report

FOLDER = ROOT / "blend_examples" / "seamless"
NAMES = ("armadillo", "critter", "hand", "mug", "pipe", "pretzel", "suzanne", "text")


def test_every_file_is_listed():
    assert sorted(path.stem for path in FOLDER.glob("*.blend")) == sorted(NAMES)


@pytest.fixture(params=NAMES)
def example(request):
    open_example(f"seamless/{request.param}")
    return bpy.context.view_layer.objects.active


def test_no_texture_breaks_off(example):
    poles = [pole for part in stored_report(example)["components"] for pole in part["tiling"]["poles"]]
    assert example.data.uv_layers.active.name == "Holomorphic"
    vertices, jumps = edge_jumps(example)
    whole = jumps[~np.isin(vertices, poles)]
    assert np.array_equal(whole, np.round(whole)) and np.abs(whole).max() >= 1


def test_its_textures_lie_beside_it(example):
    shown = {node.image for node in example.material_slots[0].material.node_tree.nodes if node.type == "TEX_IMAGE"}
    assert len(shown) == 2 and set(bpy.data.images) >= shown
    for image in shown:
        assert image.filepath.startswith("//textures/") and image.packed_file is None
        assert Path(bpy.path.abspath(image.filepath)).is_file() and image.size[0] == image.size[1] > 0


def test_it_opens_in_a_view_with_materials(example):
    views = [a for screen in bpy.data.screens for a in screen.areas if a.type == "VIEW_3D"]
    assert all(area.spaces.active.shading.type == "MATERIAL" for area in views)
