"""Each file of blend_examples: opened, processed, and checked as a whole."""

import itertools

import bpy
import numpy as np
import pytest
from loaded_addon import module
from repository import ROOT
from scenes import (
    edge_mismatch,
    mesh_io,
    open_example,
    parts_of,
    run,
    select,
    stored_report,
    straightness,
    uv,
)

# name: object, (genus, boundary loops) of its parts
EXAMPLES = {
    "torus": {"Torus": [(1, 0)]},
    "mug": {"Mug": [(1, 0)]},
    "pretzel": {"Pretzel": [(3, 0)]},
    "chain": {"Chain": [(1, 0)] * 7},
    "gear": {"Gear": [(6, 0)]},
    "knot": {"Knot": [(1, 0)]},
    "lantern": {"Lantern": [(13, 0)]},
    "clay": {"Clay": [(2, 0)]},
    "mixed": {"Ring and Pearl": [(1, 0), (0, 0)], "Bowl": [(0, 1)]},
    "hand": {"Hand": [(0, 6)]},
    "pipe": {"Pipe": [(0, 2)]},
    "critter": {"Critter": [(0, 0)]},
    "lizard": {"Lizard": [(0, 0)]},
    "armadillo": {"Armadillo": [(0, 0)]},
    "text": {"Text": [(0, 0), (1, 0)] * 4 + [(0, 0)]},  # H o l o m o r p h
    "mask": {"Mask as Disk": [(0, 1)], "Mask as Rectangle": [(0, 1)]},
}
# Mean s1/s2 on coarse faces with sharp edges is the error of linear interpolation inside triangles.
COARSE = {"gear": 1.8, "lantern": 1.35, "mixed": 1.25, "text": 1.15}
FINE = 1.12


def test_every_file_is_listed():
    assert {path.stem for path in (ROOT / "blend_examples").glob("*.blend")} == set(EXAMPLES)


@pytest.mark.parametrize("name", [*EXAMPLES, "seamless/mug"])
def test_no_example_is_folded_over_itself(name):
    """No edge is nearly a fold, and no face of a part goes through another one: such a mesh has no good map."""
    open_example(name)
    library = module("native").load()
    for obj in bpy.context.view_layer.objects:
        for part in module("scene.mesh_io").read(obj).surface(strict=False).components:
            assert np.degrees(library._native.bends(part._native).max()) < 150
            assert not len(library._native.crossings(part.vertices, part.triangles, threads=0))


def face_sizes(mesh):
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    return sizes


def test_examples_are_what_an_artist_makes():
    sizes = {}
    for name in EXAMPLES:
        open_example(name)
        sizes[name] = face_sizes(bpy.context.view_layer.objects.active.data)
    for name in ("torus", "mug", "chain", "knot", "lantern", "hand", "pipe", "mask"):
        assert np.all(sizes[name] == 4), name
    assert sizes["gear"].max() > 5
    assert 20_000 < len(sizes["knot"]) < 40_000


@pytest.mark.parametrize("name", EXAMPLES)
def test_example(name):
    open_example(name)
    objects = [bpy.data.objects[n] for n in EXAMPLES[name]]
    select(*objects)
    assert run(main="BALANCED", seams=True, evenness=0) == {"FINISHED"}
    if bpy.context.mode == "EDIT_MESH":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj in objects:
        entry = stored_report(obj)
        found = entry["components"]
        assert [(c["genus"], c["boundary_count"]) for c in found] == EXAMPLES[name][obj.name]
        assert all(c["done"] and "not_followed" not in c for c in found)
        written = [m["name"] for m in entry["maps"]]
        count = max(c["forms"] for c in found)
        assert written == ["Holomorphic", *(f"Holomorphic {j + 1}" for j in range(min(count, 8)))]
        assert obj.data.uv_layers.active.name == "Holomorphic"
        for map_name in written:
            # Several objects are given one texel density: only the one with most area fills the square.
            check_map(obj, uv(obj, map_name), found, least_extent=0.4 if len(objects) == 1 else 0.2)
        for part in found:
            assert max(part["residuals"].values()) < 1e-8
            assert 1 <= part["main_map"]["mean_angle"] < COARSE.get(name, FINE)


def check_map(obj, values, found, least_extent):
    assert np.isfinite(values).all()
    assert values.min() > -1e-6 and values.max() < 1 + 1e-6 and np.ptp(values, axis=0).max() > least_extent
    if all(part["genus"] and not part["boundary_count"] for part in found):
        difference, forgiven = edge_mismatch(obj.data, values)
        assert difference <= forgiven
        assert mesh_io.read_seams(obj.data).any()
    if all(part["boundary_count"] > 1 for part in found):
        (part,) = parts_of(obj)
        assert straightness(part, values) < 1e-6


def test_the_hand_has_the_five_forms_of_the_papers_figure():
    open_example("hand")
    hand = bpy.data.objects["Hand"]
    assert run() == {"FINISHED"}
    assert [m["name"] for m in stored_report(hand)["maps"]] == [
        "Holomorphic",
        *(f"Holomorphic {j}" for j in range(1, 6)),
    ]
    maps = [uv(hand, f"Holomorphic {j}") for j in range(1, 6)]
    assert all(not np.allclose(a, b, atol=0.01) for a, b in itertools.combinations(maps, 2))
