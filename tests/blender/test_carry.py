"""The operator that carries a UV map to another object."""

import bpy
import numpy as np
import pytest
from scenes import (
    mesh_object,
    run,
    select,
    sphere_arrays,
    torus,
    torus_arrays,
    uv_maps,
)

FULL = 8  # UV maps of a mesh


def holed_torus():
    """Without symmetry, so that its points have their own places."""
    vertices, faces = torus_arrays(36, 18)
    x, y, z = vertices.T
    faces = faces[~np.isin(np.arange(len(faces)), [5, 6, 23, 24, 300, 301])]
    return np.stack([x, y + 0.3 * x * z, z + 0.2 * x * y + 0.1 * x**2], axis=1), faces


def moebius_image(vertices):
    """By an inversion, which reverses the orientation, and a reflection."""
    from_centre = vertices - (2.5, 2.0, 1.5)
    return from_centre / (from_centre**2).sum(axis=1, keepdims=True) * (1, 1, -1)


def carry(capfd, source, target, **options):
    """What the operator returns and the sentence it reports."""
    select(target, source)
    capfd.readouterr()
    try:
        result = bpy.ops.object.holomorphic_carry(**options)
    except RuntimeError as error:
        return {"CANCELLED"}, str(error)
    return result, capfd.readouterr().out


@pytest.fixture
def source():
    obj = mesh_object("Source", *holed_torus())
    assert run() == {"FINISHED"}
    return obj


def sides_of(obj, faces):
    """(#F, 4, 2) UV vectors along the sides of quads."""
    uv = uv_maps.read_map(obj.data, obj.data.uv_layers.active.name).reshape(len(faces), 4, 2)
    return np.roll(uv, -1, axis=1) - uv


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_to_the_image_of_a_conformal_map(capfd, source, is_mirrored):
    """Every quad has its own texture, wherever the source is cut."""
    vertices, faces = holed_torus()
    target = mesh_object("Target", moebius_image(vertices), faces)
    target.scale = (-1 if is_mirrored else 1, 1, 1)
    result, said = carry(capfd, source, target)
    assert result == {"FINISHED"}
    verdict = "Mirror images within" if is_mirrored else "Indistinguishable within"
    assert f'Source to Target, UV map "Holomorphic": {verdict}' in said
    expected = sides_of(source, faces)
    difference = np.linalg.norm(sides_of(target, faces) - expected, axis=2)
    assert np.median(difference) < 0.03 * np.median(np.linalg.norm(expected, axis=2))
    assert difference.max() < np.linalg.norm(expected, axis=2).max()
    assert target.active_material == source.active_material


def test_maps_and_materials_of_ones_own_stay(capfd, source):
    vertices, faces = holed_torus()
    target = mesh_object("Target", moebius_image(vertices), faces)
    target.data.uv_layers.new(name="Holomorphic")
    target.data.materials.append(bpy.data.materials.new("Own"))
    assert carry(capfd, source, target)[0] == {"FINISHED"}
    assert [layer.name for layer in target.data.uv_layers] == ["Holomorphic", "Holomorphic.001"]
    assert target.data.uv_layers.active.name == "Holomorphic.001"
    assert [material.name for material in target.data.materials] == ["Own"]


def test_refusals(capfd, source):
    def refused(target, *sentences):
        result, said = carry(capfd, source, target)
        assert result == {"CANCELLED"}
        assert all(sentence in said for sentence in sentences), said
        return target

    target = refused(torus("Other"), "no map can be made; Not equivalent", "genus 1 and 0 boundaries")
    assert not target.data.uv_layers
    refused(mesh_object("Ball", *sphere_arrays()), "Ball: a sphere or a disk has many such maps")
    full = mesh_object("Full", *holed_torus())
    for index in range(FULL):
        full.data.uv_layers.new(name=f"Map {index}")
    refused(full, "Full has 8 UV maps, the most that Blender allows")
    for layer in [layer.name for layer in source.data.uv_layers]:
        source.data.uv_layers.remove(source.data.uv_layers[layer])
    refused(torus("Third"), "Source has no UV map")


def test_two_meshes_are_needed():
    select(torus())
    with pytest.raises(RuntimeError, match="Select two meshes"):
        bpy.ops.object.holomorphic_carry()
