"""All meshes of the shared folder by the button: maps on every part of the orientable manifold ones, the
clear sentence for the others."""

import gzip
import shutil

import bpy
import numpy as np
import pytest
from headless_runs import needs_program
from repository import SHARED
from scenes import edge_mismatch, mesh_io, native, parts_of, select, stored_report, straightness, uv_maps

MESHES = SHARED / "meshes"
RESIDUAL = 1e-8  # residual of harmonicity, closedness, periods
IN_SQUARE = 1e-6  # float32 of numbers up to 1

# file: (genus, boundary loops) of its largest part, and the number of parts
SHARED = {
    "armadillo_29k.obj": (0, 0, 1),
    "beetle_59k_b11.obj": (0, 11, 1),
    "big_brain_cit168_854k_g15.ply.gz": (15, 0, 1),
    "big_brain_cit168_half_open.ply.gz": (20, 3, 1),
    "bob_small.ply": (1, 0, 1),
    "boot_g12.obj": (12, 0, 1),
    "brain_icbm152_lh_82k.ply": (0, 0, 1),
    "bunny_60k.obj": (0, 0, 1),
    "bunny_poly.ply": (0, 0, 1),
    "bunny_stanford_raw.ply": (0, 5, 1),
    "capsule_zeroarea.obj": (0, 0, 1),
    "disk_b1.obj": (0, 1, 1),
    "double-torus.obj": (2, 0, 1),
    "elephant_g3_50k.obj": (3, 0, 1),
    "face_34k_b1.obj": (0, 1, 1),
    "featuretype_unwelded.ply": (9, 0, 1),
    "fertility_cutseam.obj": (4, 0, 1),  # apart along the cut, and joined there
    "fertility_ngon_g4.obj": (4, 0, 1),
    "fish_quads.obj": (0, 0, 1),
    "hammer_60k.obj": (0, 0, 1),
    "hand_closed.obj": (0, 0, 1),
    "hand_lowres_b1.obj": (0, 1, 1),
    "hemisphere_b1.obj": (0, 1, 1),
    "hourglass_ico.obj": (0, 0, 2),
    "inverted_triangles_b6.obj": (0, 6, 1),
    "kitten_19k.obj": (1, 0, 1),
    "lionstatue_g3_b1.obj": (3, 1, 1),
    "makehuman_base_quads.obj": (0, 0, 6),
    "nefertiti_70k.obj": (0, 0, 1),
    "penguin_control.obj": (0, 0, 1),
    "pizza_g73_b1.obj": (73, 1, 1),
    "plane_b27.obj": (0, 27, 1),
    "plate_holes_g5.stl": (5, 0, 1),
    "bunny_nonmanifold.ply": (0, 7, 148),  # cut, as the next two
    "moebius_quads.obj": (0, 1, 1),
    "triple_vierbein.obj": (0, 1, 3),
    "punctured_torus.obj": (1, 1, 1),
    "rna_3JAJ_7.off": (4, 0, 1),
    "rna_4P70_YB.off": (3, 0, 1),
    "rna_4U4Q_7.off": (4, 15, 1),
    "rockerArm_ngon.obj": (1, 0, 1),
    "skull_low_g2.obj": (2, 0, 1),
    "soccerball_g31.obj": (31, 0, 1),
    "soup_unwelded_suzanne.ply": (0, 2, 3),
    "spot_control_ngon.obj": (0, 0, 1),
    "spot_quads.obj": (0, 0, 1),
    "suzanne_blender.obj": (0, 2, 3),
    "sword_quads.obj": (0, 0, 1),
    "teapot_bff.obj": (0, 1, 4),
    "torus_ddg.obj": (1, 0, 1),
    "torus_stein.obj": (1, 0, 1),
    "tray_g23.stl": (23, 0, 1),
}


def unpacked(name, folder):
    path = MESHES / name
    if not path.exists():
        pytest.skip("no folder ../shared/meshes")
    if path.suffix != ".gz":
        return path
    with gzip.open(path) as packed, open(folder / path.stem, "wb") as plain:
        shutil.copyfileobj(packed, plain)
    return folder / path.stem


def test_every_shared_mesh_is_listed():
    if not MESHES.exists():
        pytest.skip("no folder ../shared/meshes")
    files = {path.name for path in MESHES.iterdir()}
    assert {f for f in files if not f.endswith((".md", ".nii.gz"))} == SHARED.keys()


def with_long_ones(names):
    marks = {name: [pytest.mark.long] for name in names if name.startswith("big_")}
    return [pytest.param(name, marks=marks.get(name, [])) for name in names]


@needs_program
@pytest.mark.parametrize("name", with_long_ones(SHARED))
def test_every_part_gets_a_map(name, tmp_path):
    surface = native.load().Surface.read(unpacked(name, tmp_path))
    mesh = mesh_io.new_mesh(name, surface.vertices, surface.corner_vertices, surface.face_offsets)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    select(obj)
    assert bpy.ops.uv.holomorphic_maps(main="BALANCED") == {"FINISHED"}
    entry = stored_report(obj)
    found = entry["components"]
    largest = max(found, key=lambda p: p["faces"])
    genus, boundaries, count = SHARED[name]
    assert (largest["genus"], largest["boundary_count"]) == (genus, boundaries)
    parts = sum(part.get("parts", 1) for part in found)
    assert parts == count or count == 6 and parts >= 6
    for part in found:
        assert part["done"], part
        assert max(part["residuals"].values()) < RESIDUAL
        assert part["description"]
        assert part["main_map"]["mean_angle"] is None or part["main_map"]["mean_angle"] >= 1
    check_maps(obj, entry)


def check_maps(obj, entry):
    mesh = obj.data
    parts = parts_of(obj)
    for written in entry["maps"]:
        values = uv_maps.read_map(mesh, written["name"]).astype(np.float64)
        assert np.isfinite(values).all()
        assert values.min() >= -IN_SQUARE and values.max() <= 1 + IN_SQUARE
        main = written["name"] == "Holomorphic"
        for part in parts:
            assert np.ptp(values[part.corner_index], axis=0).min() > 0 or not main, (written, part)
        each = entry["components"] if len(entry["components"]) == len(parts) else []  # else many share one
        for part, reported in zip(parts, each):
            if reported["boundary_count"] and reported["forms"]:
                assert straightness(part, values[part.corner_index]) < IN_SQUARE
        is_whole = not entry["repairs"]["joined_vertices"]["count"]
        if is_whole and all(part["boundary_count"] == 0 and part["genus"] for part in entry["components"]):
            difference, forgiven = edge_mismatch(mesh, values)
            assert difference <= forgiven, written["name"]
