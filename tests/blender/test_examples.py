"""Each file of blend_examples: opened, processed, and checked as a whole."""

import bpy
import numpy as np
import pytest
from conftest import ROOT
from scenes import edge_mismatch, mesh_io, run, select, stored_report, uv

# name: object, genus of its parts
EXAMPLES = {
    "torus": {"Torus": [1]},
    "mug": {"Mug": [1]},
    "pretzel": {"Pretzel": [3]},
    "chain": {"Chain": [1] * 7},
    "gear": {"Gear": [6]},
    "knot": {"Knot": [1]},
    "lantern": {"Lantern": [13]},
    "clay": {"Clay": [2]},
    "mixed": {"Ring and Pearl": [1, 0], "Bowl": None},
}
# Mean s1/s2 on coarse faces with sharp edges is the error of linear interpolation inside triangles.
COARSE = {"gear": 1.8, "lantern": 1.35}
FINE = 1.12


def test_every_file_is_listed():
    assert {path.stem for path in (ROOT / "blend_examples").glob("*.blend")} == set(EXAMPLES)


def face_sizes(mesh):
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    return sizes


def test_examples_are_what_an_artist_makes():
    sizes = {}
    for name in EXAMPLES:
        bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_examples" / f"{name}.blend"))
        sizes[name] = face_sizes(bpy.context.view_layer.objects.active.data)
    for name in ("torus", "mug", "chain", "knot", "lantern"):
        assert np.all(sizes[name] == 4), name
    assert sizes["gear"].max() > 5
    assert 80_000 < len(sizes["knot"]) < 120_000


@pytest.mark.parametrize("name", EXAMPLES)
def test_example(name):
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "blend_examples" / f"{name}.blend"))
    objects = [bpy.data.objects[n] for n in EXAMPLES[name]]
    select(*objects)
    assert run(seams=True) == {"FINISHED"}
    for obj in objects:
        genera = EXAMPLES[name][obj.name]
        if genera is None:
            assert not obj.data.uv_layers and "holomorph_report" not in obj
            continue
        entry = stored_report(obj)
        assert [c["genus"] for c in entry["components"]] == genera
        written = [m["name"] for m in entry["maps"]]
        assert written == ["Holomorphic", *(f"Holomorphic {j + 1}" for j in range(min(max(genera), 8)))]
        assert obj.data.uv_layers.active.name == "Holomorphic"
        assert mesh_io.read_seams(obj.data).any()
        for map_name in written:
            values = uv(obj, map_name)
            assert np.isfinite(values).all()
            assert values.min() > -1e-6 and values.max() < 1 + 1e-6 and np.ptp(values, axis=0).max() > 0.4
            difference, forgiven = edge_mismatch(obj.data, values)
            assert difference <= forgiven, map_name
        for part in entry["components"]:
            if part["done"]:
                assert max(part["residuals"].values()) < 1e-8
                assert 1 <= part["main_map"]["mean_angle"] < COARSE.get(name, FINE)
