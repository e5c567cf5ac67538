"""Islands that lie over themselves are parted until no part does."""

import costly
import numpy as np
import pytest
from holomorph import Surface, _native

TOUCHING = 1e-5  # depth of triangles that only touch, over their size


def seen_from_above(shape, size):
    """(surface, UVs)"""
    vertices, faces = costly.SHAPES[shape](size)
    surface = Surface(vertices, faces)
    return surface, np.ascontiguousarray(surface.vertices[surface.corner_vertices][:, :2])


def separates(a, b):
    """(n,) whether a side of the triangles `a`, (n, 3) complex, separates them from `b`."""
    sides = np.roll(a, -1, axis=1) - a
    inside = [(np.conj(sides)[:, :, None] * (c[:, None, :] - a[:, :, None])).imag.max(axis=2) for c in (a, b)]
    return (inside[1] <= TOUCHING * np.maximum(inside[0], np.abs(sides) ** 2)).any(axis=1)


def overlaps(surface, uv, names):
    """How many pairs of triangles of polygons with one name overlap."""
    z = (uv @ [1, 1j])[surface.triangle_corners]
    is_upright = (np.conj(z[:, 1] - z[:, 0]) * (z[:, 2] - z[:, 0])).imag > 0
    one, other = np.triu_indices(len(z), 1)
    of_one, of_other = surface.triangle_faces[one], surface.triangle_faces[other]
    wanted = is_upright[one] & is_upright[other] & (of_one != of_other) & (names[of_one] == names[of_other])
    a, b = z[one[wanted]], z[other[wanted]]
    return int((~separates(a, b) & ~separates(b, a)).sum())


@pytest.mark.parametrize("size", [30, 50, 200])
@pytest.mark.parametrize(("shape", "turns"), [("fan", 1), ("spiral", 2), ("stairs", 10)])
def test_what_winds_is_parted_turn_by_turn(shape, turns, size):
    surface, uv = seen_from_above(shape, size)
    names = _native.parted(surface._native, uv, None)
    assert overlaps(surface, uv, names) == 0
    assert len(np.unique(names)) == turns


@pytest.mark.parametrize("seed", range(10))
def test_no_part_of_a_crumpled_map_lies_over_itself(seed):
    """A grid whose corners lie farther and farther from their places: polygons are flipped, thin and over others."""
    k = 7
    at = np.arange(k * k).reshape(k, k)
    faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    grid = np.stack([*np.divmod(np.arange(k * k), k), np.zeros(k * k)], axis=1)
    surface = Surface(grid, faces.tolist())
    places = grid[:, :2] + 0.2 * seed * np.random.default_rng(seed).normal(size=(k * k, 2))
    uv = np.ascontiguousarray(places[surface.corner_vertices])
    names = _native.parted(surface._native, uv, None)
    assert overlaps(surface, uv, names) == 0
    assert seed > 0 or len(np.unique(names)) == 1
