"""Each file of blend_examples/things: what stands on the tiling is there as soon as it is opened."""

import bpy
import numpy as np
import pytest
from repository import ROOT
from scenes import open_example

FOLDER = ROOT / "blend_examples" / "things"
MANY = 200
OF_FACES = {"mug_wicker": "Mug Lines", "pretzel_bricks": "Pretzel Cells", "vase_knurled": "Vase Relief"}
BAKED = "human_baked"
OF_PIECES = {
    "armadillo_chain_mail": "Armadillo Geometry",
    "critter_knitted": "Critter Geometry",
    "lizard_scales": "Lizard Geometry",
}


def test_every_file_is_listed():
    assert {path.stem for path in FOLDER.glob("*.blend")} == {BAKED} | OF_FACES.keys() | OF_PIECES.keys()


@pytest.mark.parametrize("name", OF_PIECES)
def test_there_is_a_piece_on_every_tile(name):
    open_example(f"things/{name}")
    made = bpy.data.objects[OF_PIECES[name]]
    bpy.context.view_layer.update()
    shown = bpy.context.evaluated_depsgraph_get().object_instances
    count = sum(i.is_instance and i.parent.original == made for i in shown)
    assert MANY < count <= len(made.data.vertices)


@pytest.mark.parametrize("name", OF_FACES)
def test_it_has_a_surface_of_its_own(name):
    open_example(f"things/{name}")
    made = bpy.data.objects[OF_FACES[name]]
    bpy.context.view_layer.update()
    shown = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert len(shown.polygons) > MANY
    mortar = {"Surface"} if name == "pretzel_bricks" else set()
    assert {shown.materials[face.material_index].name for face in shown.polygons} == {"Pieces"} | mortar


def test_the_vase_is_closed_and_stands_on_its_foot():
    open_example("things/vase_knurled")
    raised, plain = (bpy.data.objects[name].data for name in ("Vase Relief", "Vase"))
    sides = np.empty(len(raised.loops), np.int32)
    raised.loops.foreach_get("edge_index", sides)
    assert (np.bincount(sides) == 2).all()
    heights = [min(vertex.co.z for vertex in mesh.vertices) for mesh in (raised, plain)]
    assert heights[0] == pytest.approx(heights[1], abs=0.1)  # millimetres


def test_the_human_shows_an_atlas_and_keeps_the_tiling():
    open_example(f"things/{BAKED}")
    human = bpy.data.objects["Human"]
    material = human.material_slots[0].material
    shown = {node.image.name for node in material.node_tree.nodes if node.type == "TEX_IMAGE"}
    assert shown == {"Human Colour", "Human Normal"}
    assert {"Holomorphic", "Holomorphic Bake"} <= {layer.name for layer in human.data.uv_layers}


@pytest.mark.parametrize("name", [*OF_PIECES, *OF_FACES, BAKED])
def test_its_files_are_small_and_need_no_others(name):
    open_example(f"things/{name}")
    assert (FOLDER / f"{name}.blend").stat().st_size < 2**20
    files = [image for image in bpy.data.images if image.source == "FILE" and not image.packed_file]
    assert not bpy.data.libraries and not files
