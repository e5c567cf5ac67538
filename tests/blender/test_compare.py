"""The operator that compares two objects."""

import bpy
import numpy as np
import pytest
from scenes import mesh_object, select, sphere_arrays, torus, torus_arrays, two_parts


def compare(capfd, *objects):
    """What the operator returns and the sentence it reports."""
    select(*objects)
    capfd.readouterr()
    try:
        result = bpy.ops.object.holomorphic_compare()
    except RuntimeError as error:
        return {"CANCELLED"}, str(error)
    return result, capfd.readouterr().out


def test_an_object_and_its_image(capfd):
    first, second = torus("First"), torus("Second")
    second.matrix_world = np.diag([2.0, 2.0, 2.0, 1.0])
    result, said = compare(capfd, first, second)
    assert result == {"FINISHED"}
    assert "First, Second: Equivalent: their triangles are similar, to rounding." in said


def test_a_negative_scale_is_a_mirror_image(capfd):
    """The torus is twisted, so that it is not its own mirror image."""
    vertices, faces = torus_arrays(36, 18, 0.5)
    radius, height = np.hypot(vertices[:, 0], vertices[:, 1]), vertices[:, 2].copy()
    angle = np.arctan2(vertices[:, 1], vertices[:, 0])
    around = np.arctan2(height, radius - 1)
    bump = 1 + 0.4 * np.sin(around - 2 * angle)
    vertices = np.stack([vertices[:, 0], vertices[:, 1], height * bump], axis=1)
    first, second = mesh_object("First", vertices, faces), mesh_object("Second", vertices, faces)
    second.scale = (-1, 1, 1)
    result, said = compare(capfd, first, second)
    assert result == {"FINISHED"}
    assert "First, Second: Mirror images of each other: their triangles are similar" in said
    third = mesh_object("Third", vertices * (-1, 1, 1), faces[:, ::-1])
    assert "First, Third: Mirror images of each other" in compare(capfd, first, third)[1]


def test_different_objects(capfd):
    assert "Not equivalent: every map" in compare(capfd, torus(), torus(thickness=0.2))[1]
    assert "genus 1 and 0 boundaries, and genus 0" in compare(capfd, torus(), mesh_object("Ball", *sphere_arrays()))[1]


def test_several_parts_are_refused(capfd):
    both = two_parts("Both", torus_arrays(), sphere_arrays())
    result, said = compare(capfd, both, torus())
    assert result == {"CANCELLED"}
    assert "Both: the surface has 2 connected components" in said


def test_two_meshes_are_needed():
    select(torus())
    with pytest.raises(RuntimeError, match="Select two meshes"):
        bpy.ops.object.holomorphic_compare()
