"""Islands by hard edges: offered where a mesh is too coarse for one map, made without shearing, overlaps told."""

import json
import math
import re

import bpy
import numpy as np
import pytest
from headless_runs import pressed_here, sets, write_obj
from loaded_addon import module
from packed import assert_packed, capped_cylinder
from scenes import everything, mesh_io, mesh_object, run, select, stored_report


def primitive(make, **options):
    make(**options)
    obj = bpy.context.object
    while obj.data.uv_layers:
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
    return obj


def cone():
    return primitive(bpy.ops.mesh.primitive_cone_add)


def helix():
    """A flat strip that winds one and a half times around an axis, rising."""
    n = 120
    angle = np.linspace(0, 3 * np.pi, n)
    rails = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.05 * angle], axis=1) for r in (1, 1.5, 2)]
    i = np.arange(n - 1)
    quads = [np.stack([i + k * n, i + (k + 1) * n, i + 1 + (k + 1) * n, i + 1 + k * n], axis=1) for k in range(2)]
    obj = mesh_object("Helix", np.concatenate(rails), np.concatenate(quads))
    mesh_io.mark_edges(obj.data, "use_seam", [[n // 2, n // 2 + n]])  # opens nothing
    return obj


def main_maps(obj):
    return [part["main_map"] for part in stored_report(obj)["components"]]


def island_count(obj):
    """The object has one part."""
    (found,) = main_maps(obj)
    return int(re.search(r"into (\d+) piece|in one piece", found["why"])[1] or 1)


@pytest.mark.parametrize("make", [cone, lambda: primitive(bpy.ops.mesh.primitive_cylinder_add)])
def test_the_button_makes_islands_without_shearing(make):
    obj = make()
    run()
    assert bpy.ops.uv.holomorphic_islands() == {"FINISHED"}
    assert [found["mean_angle"] for found in main_maps(obj)] == pytest.approx([1] * len(main_maps(obj)), abs=1e-3)
    assert_packed(obj)
    assert stored_report(obj)["verdict"]["level"] == "good"


def test_edges_that_are_marked_sharp_are_hard_whatever_their_angle():
    """A can whose side is cut along two of its edges, besides the caps."""
    obj = capped_cylinder()
    upright = [e.index for e in obj.data.edges if np.ptp([obj.data.vertices[v].co.z for v in e.vertices]) > 1]
    for index in upright[:2]:
        obj.data.edges[index].use_edge_sharp = True
    for edge in obj.data.edges:
        edge.use_seam = False
    assert bpy.ops.uv.holomorphic_islands(hard_edges=math.radians(60)) == {"FINISHED"}
    assert island_count(obj) == 4


def test_marks_of_flat_shading_are_no_hard_edges():
    obj = capped_cylinder()
    for edge in obj.data.edges:
        edge.use_edge_sharp, edge.use_seam = True, False
    assert bpy.ops.uv.holomorphic_islands(hard_edges=math.radians(60)) == {"FINISHED"}
    assert island_count(obj) == 3


def test_the_maps_operator_goes_on_with_islands_until_it_is_told_otherwise():
    obj = cone()
    assert bpy.ops.uv.holomorphic_islands() == {"FINISHED"}
    assert stored_report(obj)["dials"]["main"] == "ISLANDS"
    for asked, main in (({}, "ISLANDS"), ({"main": "AUTOMATIC"}, "AUTOMATIC"), ({}, "AUTOMATIC")):
        assert bpy.ops.uv.holomorphic_maps(**asked) == {"FINISHED"}
        assert stored_report(obj)["dials"]["main"] == main


def test_mark_seams_marks_where_islands_were_cut():
    """Around the base, and once up to the tip."""
    obj = cone()
    assert bpy.ops.uv.holomorphic_islands(seams=True) == {"FINISHED"}
    height = [{obj.data.vertices[v].co.z for v in e.vertices} for e in obj.data.edges if e.use_seam]
    assert len(height) == 33 and sum(len(each) == 2 for each in height) == 1
    assert run(main="ISLANDS") == {"FINISHED"}
    assert island_count(obj) == 2


def test_a_text_is_to_be_converted_and_then_flattened():
    """Its letters come with faces, backs and sides apart."""
    bpy.ops.object.text_add()
    obj = bpy.context.object
    obj.data.extrude = 0.1
    operators, availability = module("operators.mapping"), module("operators.mixins")
    assert operators.HOLOMORPH_OT_maps.why_not(bpy.context) == availability.CONVERT
    bpy.ops.object.convert(target="MESH")
    assert operators.HOLOMORPH_OT_maps.why_not(bpy.context) == ""
    run()
    assert bpy.ops.uv.holomorphic_islands() == {"FINISHED"}
    assert stored_report(bpy.context.object)["verdict"]["level"] in ("good", "fair")


def test_the_angle_decides():
    """The sides of a prism with eight sides meet at 45 degrees."""
    obj = primitive(bpy.ops.mesh.primitive_cylinder_add, vertices=8)
    counts = []
    for degrees in (40, 50):
        assert bpy.ops.uv.holomorphic_islands(hard_edges=math.radians(degrees)) == {"FINISHED"}
        counts.append(island_count(obj))
    assert counts == [10, 3]


def test_a_smooth_closed_mesh_says_what_to_do():
    obj = primitive(bpy.ops.mesh.primitive_ico_sphere_add, subdivisions=4)
    before = everything(obj)
    with pytest.raises(RuntimeError, match="no edge is that sharp: choose a smaller angle"):
        bpy.ops.uv.holomorphic_islands()
    assert everything(obj) == before


def test_what_would_lie_over_itself_is_parted():
    obj = helix()
    select(obj)
    assert run(main="ISLANDS") == {"FINISHED"}
    (found,) = main_maps(obj)
    assert found["overlapping_part"] == 0 and island_count(obj) >= 2
    assert_packed(obj)


def can_file(folder, n=24):
    """A cylinder with a face for each cap."""
    turn = 2 * np.pi * np.arange(n) / n
    rim = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    vertices = np.concatenate([np.pad(rim, ((0, 0), (0, 1)), constant_values=z) for z in (-1, 1)])
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return write_obj(folder / "can.obj", vertices, [*sides, list(range(n))[::-1], list(range(n, 2 * n))])


def test_the_command_cuts_along_hard_edges(tmp_path):
    report, path = tmp_path / "report.json", can_file(tmp_path)
    pressed_here(path, "--press", "islands", *sets(f"hard_edges={math.radians(40)}"), "--report", report)
    (entry,) = json.loads(report.read_text())["objects"]
    (part,) = entry["components"]
    assert part["faces"] == 26 and "into 3 pieces" in part["main_map"]["why"]
    assert part["main_map"]["mean_angle"] == pytest.approx(1, abs=1e-3)


def test_a_face_without_area_is_in_the_island_at_its_longest_side():
    """The cube's six islands are six squares still."""
    obj = primitive(bpy.ops.mesh.primitive_cube_add)
    vertices = [tuple(vertex.co) for vertex in obj.data.vertices]
    faces = [tuple(polygon.vertices) for polygon in obj.data.polygons]
    a, b, *rest = faces[2]
    middle = tuple((np.array(vertices[a]) + vertices[b]) / 2)
    faces[2] = (a, len(vertices), b, *rest)
    bad = mesh_object("Sliver", [*vertices, middle], [*faces, (a, b, len(vertices))])
    assert bpy.ops.uv.holomorphic_islands(hard_edges=math.radians(40)) == {"FINISHED"}
    report = stored_report(bad)
    assert report["faces"] == 7 and not report["whole"]["unmapped_faces"]
