"""Disks in Blender: rectangles with picked corners, round disks, what is chosen by itself."""

import bpy
import numpy as np
import pytest
from scenes import (
    boundary_corners,
    mesh_object,
    parts_of,
    pick,
    run,
    stored_report,
    uv,
)

FLOAT32 = 1e-6  # part of the UV size


def only_part(obj):
    (entry,) = stored_report(obj)["components"]
    return entry


def sheet_arrays(count=16):
    """A bent square sheet of quads; vertex i (count + 1) + j is column i, row j."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    x, y = i / count, j / count
    vertices = np.stack([1.5 * x, y + 0.2 * x * x, 0.3 * np.sin(4 * x) * y], -1).reshape(-1, 3)
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    return vertices, np.stack([a, a + count + 1, a + count + 2, a + 1], -1)


def test_four_picked_corners_make_a_rectangle():
    count = 16
    obj = mesh_object("Sheet", *sheet_arrays(count))
    corners = [0, count * (count + 1), (count + 1) ** 2 - 1, count]
    pick(obj, [corners[k] for k in (0, 2, 1, 3)])
    assert run() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    values, (part,) = uv(obj), parts_of(obj)
    low, high = values.min(axis=0), values.max(axis=0)
    at = {int(v): values[k] for k, v in enumerate(part.corner_vertices)}
    found = np.array([at[c] for c in corners])
    for corner in found:
        assert np.minimum(np.abs(corner - low), np.abs(corner - high)).max() < FLOAT32
    assert len(np.unique(np.round(found, 5), axis=0)) == 4
    ends = values[boundary_corners(part)].reshape(-1, 2)
    assert np.minimum(np.abs(ends - low), np.abs(ends - high)).min(axis=1).max() < FLOAT32
    entry = only_part(obj)
    assert entry["description"].startswith("rectangle")
    lower, upper = entry["modulus_bounds"]
    width, height = high - low
    assert lower <= entry["modulus"] <= upper
    # The map stands upright: its height is that of the rectangle, or its width.
    assert any(entry["modulus"] == pytest.approx(each, rel=1e-5) for each in (height / width, width / height))


def test_one_picked_vertex_makes_a_round_disk():
    count = 16
    obj = mesh_object("Sheet", *sheet_arrays(count))
    pick(obj, [5 * (count + 1) + 9])
    assert run() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert only_part(obj)["description"].startswith("disk")
    values, (part,) = uv(obj), parts_of(obj)
    centre = values[part.corner_vertices == 5 * (count + 1) + 9]
    assert np.ptp(centre, axis=0).max() < FLOAT32
    radius = np.linalg.norm(values[boundary_corners(part)].reshape(-1, 2) - centre[0], axis=1)
    assert np.ptp(radius) < 4 * FLOAT32
