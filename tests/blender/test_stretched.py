"""A button selects the faces on which a texture is too large, too small or sheared."""

import bpy
import numpy as np
import pytest
from loaded_addon import module
from scenes import grid_arrays, mesh_io, mesh_object, select, torus

Values = module("compatibility").Values


def press(**options):
    return bpy.ops.mesh.holomorphic_select_stretched(**options)


def selected(obj):
    bpy.ops.object.mode_set(mode="OBJECT")
    return np.flatnonzero(mesh_io.read_values(Values(obj.data.polygons, "select", bool))).tolist()


def squares(stretch):
    """A flat grid with the UVs of its positions; those of face 0 alone are stretched."""
    vertices, faces = grid_arrays()
    vertices[:, 2] = 0
    obj = mesh_object("Grid", vertices, faces)
    corners = np.array([vertices[v][:2] for face in faces for v in face], np.float32)
    corners[:4] *= stretch
    layer = obj.data.uv_layers.new(name="Mine")
    mesh_io.write_values(module("compatibility").uv_values(layer), corners)
    return obj


@pytest.mark.parametrize("stretch", [(3, 3), (0.3, 0.3), (1, 3)])
def test_the_face_that_is_too_large_too_small_or_sheared(stretch):
    obj = squares(stretch)
    assert press() == {"FINISHED"}
    assert obj.mode == "EDIT" and tuple(bpy.context.scene.tool_settings.mesh_select_mode) == (False, False, True)
    assert selected(obj) == [0]
    assert press(size=4, angle=4) == {"CANCELLED"} and obj.mode == "OBJECT"


def test_size_is_a_length_and_angle_a_ratio():
    obj = squares((3, 3))
    assert press(size=2.9) == {"FINISHED"} and selected(obj) == [0]
    assert press(size=3.1) == {"CANCELLED"}
    obj = squares((1, 3))
    assert press(size=9, angle=2.9) == {"FINISHED"} and selected(obj) == [0]
    assert press(size=9, angle=3.1) == {"CANCELLED"}


def test_edit_mode_stays_and_objects_without_a_map_are_left_alone():
    obj, other = squares((3, 3)), torus()
    select(obj, other)
    bpy.ops.object.mode_set(mode="EDIT")
    assert press() == {"FINISHED"} and other.mode == "EDIT"
    assert selected(obj) == [0]


def test_without_a_map_there_is_nothing():
    torus()
    assert press() == {"CANCELLED"}
