"""The double cover in Blender."""

import numpy as np
import pytest
from scenes import (
    fills_the_square,
    mesh_object,
    run,
    stored_report,
    uv,
)

FLOAT32 = 1e-6  # of the UV size


def only_part(obj):
    (entry,) = stored_report(obj)["components"]
    return entry


def tube_arrays(around=32, along=12):
    """An uneven tube: triangles of all shapes, both ends wavy."""
    i, j = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    angle, height = 2 * np.pi * i / around + 0.2 * np.sin(j), j / 3 + 0.2 * np.sin(3 * 2 * np.pi * i / around)
    radius = 1 + 0.3 * np.sin(height) + 0.2 * np.cos(2 * angle)
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], -1).reshape(-1, 3)
    a = np.arange(around * along).reshape(around, along)
    b = np.roll(a, -1, axis=0)
    return vertices, np.stack([a[:, :-1], b[:, :-1], b[:, 1:], a[:, 1:]], -1).reshape(-1, 4)


def test_the_double_cover_gives_the_same_map():
    obj = mesh_object("Tube", *tube_arrays())
    run()
    natural, entry = uv(obj), only_part(obj)
    assert run(boundary="double_cover") == {"FINISHED"}
    assert only_part(obj)["modulus"] == pytest.approx(entry["modulus"], rel=1e-9)
    for values in (natural, uv(obj)):
        assert fills_the_square(values)
