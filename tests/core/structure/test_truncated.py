"""Closed surfaces of genus 0 so coarse that the stars of any two vertices meet."""

import holomorph
import numpy as np
import pytest
from holomorph.forms.log_map import TruncatedStructure

SAME = 1e-9  # two solves, or rounding


def pyramid(sides, height=2.0):
    """A base polygon and triangles to an apex."""
    angle = 2 * np.pi * np.arange(sides) / sides + 0.1 * np.sin(np.arange(sides))
    vertices = np.vstack([np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)]), [[0.2, 0.1, height]]])
    return vertices, [list(range(sides))[::-1]] + [[i, (i + 1) % sides, sides] for i in range(sides)]


def as_polygons(vertices, faces):
    return vertices, np.concatenate(faces), np.cumsum([0, *map(len, faces)])


def solved(sides):
    surface = holomorph.Surface(*pyramid(sides))
    return surface, holomorph.log_map(surface)


def triangle_sides(structure):
    """(corner at the lower vertex, corner at the higher one, edge) of each side of a triangle."""
    native = structure.surface.components[0]._native
    corners = np.stack([native.triangle_corners, np.roll(native.triangle_corners, -1, axis=1)], axis=-1).reshape(-1, 2)
    ends = native.corner_vertices[corners]
    corners = np.where((ends[:, 0] < ends[:, 1])[:, None], corners, corners[:, ::-1])
    index = {tuple(edge): k for k, edge in enumerate(structure.edges.tolist())}
    return *corners.T, np.array([index[tuple(sorted(edge))] for edge in ends.tolist()])


SIDES = [3, 4, 5, 8, 32]


@pytest.mark.parametrize("sides", SIDES)
def test_every_corner_has_a_uv_and_no_triangle_is_flipped(sides):
    _, structure = solved(sides)
    assert isinstance(structure, TruncatedStructure)
    uv = structure.uv(structure.balanced_coefficients())
    quality = structure.quality(uv)
    assert np.isfinite(uv).all() and not quality.flipped.any()
    assert quality.area.min() > 0
    assert "log map" in structure.description and len(structure.poles) == 2


@pytest.mark.parametrize("sides", SIDES)
def test_seams_shift_by_whole_periods(sides):
    surface, structure = solved(sides)
    uv = structure.uv(structure.balanced_coefficients())
    tails, heads, edges = triangle_sides(structure)
    order = np.argsort(edges, kind="stable").reshape(-1, 2)
    jump = np.array([uv[c][order[:, 0]] - uv[c][order[:, 1]] for c in (tails, heads)])
    is_seam = np.isin(np.arange(len(order)), structure.seams)
    assert np.abs(jump[:, ~is_seam]).max() < SAME
    spoke = np.isin(structure.edges, structure.poles).any(axis=1)
    shift = jump[:, is_seam & ~spoke]
    assert np.abs(shift[0] - shift[1]).max(initial=0) < SAME
    assert np.abs(shift - np.round(shift) * (1, 0)).max(initial=0) < SAME
    forms = structure.holomorphic_forms
    assert forms.shape == (1, len(structure.edges)) and np.array_equal(np.isnan(forms[0]), spoke)


@pytest.mark.parametrize("sides", SIDES)
def test_the_averaged_star_is_that_of_the_mesh_itself(sides):
    """Not of its truncation, which has more edges."""
    surface, structure = solved(sides)
    height = surface.vertices[:, 2]
    tails, heads = structure.edges.T
    star = structure.averaged_star(height[heads] - height[tails])
    assert star.shape == (len(structure.edges),)
    assert np.isfinite(star).all() and np.abs(star).max() <= np.abs(surface.vertices).max() * len(structure.edges)
    assert np.array_equal(structure.averaged_star(2 * (height[heads] - height[tails])), 2 * star)


def test_size_and_place_of_the_mesh_do_not_matter():
    vertices, faces = pyramid(6)
    maps = []
    for moved in (vertices, 1e6 * vertices, vertices[:, [1, 2, 0]] + 5):
        structure = holomorph.log_map(holomorph.Surface(moved, faces))
        maps.append(structure.uv([1.0]))
    assert np.abs(maps[1] - maps[0]).max() < SAME and np.abs(maps[2] - maps[0]).max() < SAME


def test_the_sphere_map_of_a_tetrahedron():
    surface, structure = solved(3)
    points = structure.sphere_map()
    assert points.shape == (4, 3)
    assert np.linalg.norm(points, axis=1) == pytest.approx(1, rel=1e-9)


def test_vertices_of_a_surface_with_loose_ones_keep_their_numbers():
    vertices, faces = pyramid(4)
    surface = holomorph.Surface(np.vstack([[[9, 9, 9]], vertices]), [[v + 1 for v in face] for face in faces])
    structure = holomorph.log_map(surface)
    assert set(structure.poles) <= set(range(1, 6))
    assert structure.edges.min() == 1
    assert np.isnan(structure.sphere_map()[0]).all()


def test_poles_that_are_asked_for_must_be_apart_all_the_same():
    with pytest.raises(holomorph.TopologyError, match="meet|share|corners of one face"):
        holomorph.log_map(holomorph.Surface(*pyramid(4)), [0, 4])


def test_without_positions_nothing_is_cut_off():
    _, faces = pyramid(3)
    surface = holomorph.Surface.from_edge_lengths(np.array(faces), np.ones((4, 3)))
    with pytest.raises(holomorph.TopologyError, match="too coarse for two poles: .* subdivide the mesh"):
        holomorph.log_map(surface)


def pillow(sides, fan):
    """A polygon, and as its other side triangles around vertex `fan`: most vertices lie between two faces only."""
    angle = 2 * np.pi * np.arange(sides) / sides
    around = [(fan + k) % sides for k in range(1, sides)]
    faces = [[fan, b, a] for a, b in zip(around, around[1:])]
    return np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)]), [list(range(sides)), *faces]


@pytest.mark.parametrize(("sides", "fan"), [(4, 0), (4, 1), (5, 2), (8, 0), (8, 5)])
def test_no_pole_lies_between_two_faces(sides, fan):
    surface = holomorph.Surface.from_polygons(*as_polygons(*pillow(sides, fan)))
    structure = holomorph.log_map(surface)
    corners = surface.components[0].corner_vertices
    assert isinstance(structure, TruncatedStructure)
    assert (np.bincount(corners)[list(structure.poles)] > 2).all()
    assert np.isfinite(structure.uv(structure.balanced_coefficients())).all()
    assert holomorph.automatic_map(surface).kind == "islands"
