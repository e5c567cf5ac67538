"""Every mesh that Blender's Add menu makes gets a map that is not degenerate, with one press of the button."""

import bpy
import numpy as np
import pytest
from scenes import parts_of, run, stored_report, straightness, uv

add = bpy.ops.mesh
# name: maker, (genus, boundary loops) of its parts
PRIMITIVES = {
    "plane": (add.primitive_plane_add, {}, [(0, 1)]),
    "cube": (add.primitive_cube_add, {}, [(0, 0)]),
    "circle": (add.primitive_circle_add, {"fill_type": "NGON"}, [(0, 1)]),
    "fan": (add.primitive_circle_add, {"fill_type": "TRIFAN"}, [(0, 1)]),
    "sphere": (add.primitive_uv_sphere_add, {}, [(0, 0)]),
    "icosphere": (add.primitive_ico_sphere_add, {}, [(0, 0)]),
    "icosahedron": (add.primitive_ico_sphere_add, {"subdivisions": 1}, [(0, 0)]),
    "cylinder": (add.primitive_cylinder_add, {}, [(0, 0)]),
    "fan-capped cylinder": (add.primitive_cylinder_add, {"end_fill_type": "TRIFAN"}, [(0, 0)]),
    "pipe": (add.primitive_cylinder_add, {"end_fill_type": "NOTHING"}, [(0, 2)]),
    "cone": (add.primitive_cone_add, {}, [(0, 0)]),
    "open cone": (add.primitive_cone_add, {"end_fill_type": "NOTHING"}, [(0, 1)]),
    "cut cone": (add.primitive_cone_add, {"radius2": 0.5, "end_fill_type": "NOTHING"}, [(0, 2)]),
    "pyramid": (add.primitive_cone_add, {"vertices": 4}, [(0, 0)]),
    "tetrahedron": (add.primitive_cone_add, {"vertices": 3}, [(0, 0)]),
    "torus": (add.primitive_torus_add, {}, [(1, 0)]),
    "grid": (add.primitive_grid_add, {}, [(0, 1)]),
    "monkey": (add.primitive_monkey_add, {}, [(0, 1), (0, 1), (0, 2)]),
}


def uv_area(part, values):
    """Sum of the areas of the triangles, whichever way they lie."""
    p, q, r = values[part.corner_index][part.triangle_corners].transpose(1, 0, 2)
    d, e = q - p, r - p
    return 0.5 * np.abs(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]).sum()


@pytest.mark.parametrize("name", PRIMITIVES)
def test_primitive(name):
    maker, options, topologies = PRIMITIVES[name]
    maker(**options)
    obj = bpy.context.object
    assert run() == {"FINISHED"}
    found = stored_report(obj)["components"]
    assert sorted((p["genus"], p["boundary_count"]) for p in found) == topologies
    values = uv(obj)
    assert np.isfinite(values).all() and values.min() > -1e-6 and values.max() < 1 + 1e-6
    for part, reported in zip(parts_of(obj), found):
        assert reported["done"] and reported["description"], reported
        assert uv_area(part, values) > 0.005 * part.area / sum(each.area for each in parts_of(obj))
        assert reported["main_map"]["flipped_triangles"] <= 0.1 * len(part.triangles)
        if reported["boundary_count"] == 2:
            assert straightness(part, values[part.corner_index]) < 1e-6


def test_default_scene():
    """What a beginner sees first: the cube that Blender starts with."""
    bpy.ops.wm.read_factory_settings()
    cube = bpy.data.objects["Cube"]
    assert run() == {"FINISHED"}
    assert cube.data.uv_layers.active.name == "Holomorphic"


def test_in_edit_mode_with_everything_selected():
    """As a new mesh is: all of it is selected, which is not a choice of vertices."""
    bpy.ops.mesh.primitive_uv_sphere_add()
    obj = bpy.context.object
    run()
    expected = uv(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    run()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(uv(obj), expected)
