"""Each file of blend_examples/things: what stands on the tiling is there as soon as it is opened."""

import bpy
import pytest
from repository import ROOT
from scenes import open_example

FOLDER = ROOT / "blend_examples" / "things"
MANY = 200
OF_FACES = {"mug_wicker": "Mug Lines", "pretzel_bricks": "Pretzel Cells"}
OF_PIECES = {
    "armadillo_chain_mail": "Armadillo Geometry",
    "critter_knitted": "Critter Geometry",
    "lizard_scales": "Lizard Geometry",
}


def test_every_file_is_listed():
    assert {path.stem for path in FOLDER.glob("*.blend")} == OF_FACES.keys() | OF_PIECES.keys()


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
    assert {shown.materials[face.material_index].name for face in shown.polygons} == {"Pieces"}


@pytest.mark.parametrize("name", OF_PIECES | OF_FACES)
def test_its_files_are_small_and_need_no_others(name):
    open_example(f"things/{name}")
    assert (FOLDER / f"{name}.blend").stat().st_size < 2**20
    assert not bpy.data.libraries and not [image for image in bpy.data.images if image.source == "FILE"]
