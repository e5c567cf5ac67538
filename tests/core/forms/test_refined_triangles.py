"""Triangles cut at midpoints of sides, or their corners cut off: areas in exact fractions, what rounding makes of
lengths, and forms that remain what they are."""

from fractions import Fraction

import numpy as np
import pytest
from exact_metrics import UNIT, exact, growth
from holomorph import _native
from holomorph.forms.narrow_bounds import surface_of_triangles, vertex_exponents
from holomorph.forms.refined_triangles import CUT, Triangles, areas, halved, with_layers

NEAR = 0.1  # part of a bound that some true error exceeds
HEIGHTS = [1.0, 1e-2, 1e-5]


def random_triangles(height, count):
    """(count, 3) lengths, the first one between 1 and 2, the second between `height` and twice that."""
    random = np.random.default_rng(0)
    a, b = random.uniform(1, 2, count), height * random.uniform(1, 2, count)
    return np.stack([a, b, np.sqrt(a * a + b * b - 2 * a * b * np.cos(random.uniform(0.1, 3.0, count)))], axis=1)


@pytest.mark.parametrize("height", [*HEIGHTS, 1e-9])
def test_areas(height):
    """Heron's formula in Kahan's order: 11 units of the product, 1 of the root."""
    sides = random_triangles(height, 500)
    for lengths, area in zip(sides, areas(sides), strict=True):
        a, b, c = map(Fraction, lengths)
        square = (a + b + c) * (b + c - a) * (a + c - b) * (a + b - c) / 16
        assert abs(Fraction(area) ** 2 - square) <= 13 * UNIT * square


def with_neighbours(lengths, error):
    """`Triangles`: one, and across each of its sides a congruent one; all stand for others with this error."""
    edges = np.array([[0, 1, 2], [0, 3, 4], [1, 5, 6], [2, 7, 8]])
    corners = np.array([[0, 1, 2], [1, 0, 3], [2, 1, 4], [0, 2, 5]])
    a, b, c = lengths
    of_edges = np.array([a, b, c, b, c, c, a, a, b])
    return Triangles(corners, edges, of_edges, np.full(4, error), np.zeros((4, 3, 1), int))


def exact_squares(lengths, places, sides):
    """(#T, 3) the exact squares of what `sides` are: distances of points of the triangle with these `lengths`, given by
    (numerators of) barycentric coordinates over 4."""
    a, b, c = exact(lengths) * exact(lengths)
    known = []
    for i, p in enumerate(places):
        for q in places[:i]:
            x, y, z = (int(k) for k in np.subtract(p, q))
            known.append((-x * y * a - y * z * b - z * x * c) / 16)
    known = np.array(known)
    return known[np.abs(np.sqrt(known.astype(float)) / sides[:, :, None] - 1).argmin(axis=2)]


CORNERS = [(4, 0, 0), (0, 4, 0), (0, 0, 4)]
MIDPOINTS = [(2, 2, 0), (0, 2, 2), (2, 0, 2)]
QUARTERS = [(3, 1, 0), (1, 3, 0), (0, 3, 1), (0, 1, 3), (1, 0, 3), (3, 0, 1)]


def cut_in_two_ways(lengths, cut):
    """The pieces of one triangle and its neighbours when its sides `cut` are halved, and when corners are cut off."""
    triangles = with_neighbours(lengths, 0.0)
    yield halved(triangles, np.isin(np.arange(-1, 3), cut)), [*CORNERS, *MIDPOINTS]
    yield with_layers(triangles, np.isin(np.arange(6), cut).astype(int)), [*CORNERS, *QUARTERS]


@pytest.mark.parametrize("cut", [[0], [1], [2], [0, 2], [0, 1, 2]], ids=str)
@pytest.mark.parametrize("height", HEIGHTS)
def test_energies_grow_by_no_more_than_lengths_are_rounded(height, cut):
    parts = []
    for lengths in random_triangles(height, 10):
        for pieces, places in cut_in_two_ways(lengths, cut):
            grown = growth(pieces.sides, exact_squares(lengths, places, pieces.sides))
            assert (grown <= pieces.errors).all()
            parts.append((grown[pieces.errors > 0] / pieces.errors[pieces.errors > 0]).max(initial=0))
    assert np.max(parts) > NEAR


def test_errors_that_were_there_remain():
    """A piece of what stands for another triangle does so, too: the factors 1 + error multiply."""
    for lengths in random_triangles(1e-4, 100):
        marked = np.array([False, True, False, False])
        without, pieces = (halved(with_neighbours(lengths, error), marked) for error in (0.0, 1e-3))
        exactly = [(1 + Fraction(1e-3)) * (1 + Fraction(growth)) - 1 for growth in without.errors]
        assert all(abs(Fraction(error) - sure) <= 1e-15 for error, sure in zip(pieces.errors, exactly, strict=True))


def test_layers_are_similar_exactly():
    """The corner of a triangle after k layers has CUT^k of its sides, and no error."""
    for lengths in random_triangles(1.0, 20):
        pieces = with_layers(with_neighbours(lengths, 0.0), np.array([9, 0, 0, 0, 0, 0]))
        smallest = pieces.sides[(pieces.corners == 0).any(axis=1)]
        assert len(smallest) == 3
        assert all(sorted(sides) == sorted(CUT**9 * lengths) for sides in smallest)
        assert (pieces.errors[(pieces.corners == 0).any(axis=1)] == 0).all()


# ---- what is cut remains the same surface, and forms on it --------------------------------------------------------


def torus(n):
    """`Triangles` of a slanted flat torus of n^2 parallelograms with the sides 1 / n and 1.2 / n, and the classes of du
    and dv of the plane, n u and n v whole numbers at vertices: constant forms, which elements of any order have."""
    i = np.arange(n * n)
    right, up = i // n * n + (i + 1) % n, (i + n) % (n * n)
    across = up // n * n + (up + 1) % n
    corners = np.concatenate([np.stack([i, right, across], axis=1), np.stack([i, across, up], axis=1)])
    level, upright, diagonal = i, n * n + i, 2 * n * n + i
    edges = np.concatenate(
        [np.stack([level, upright[right], diagonal], axis=1), np.stack([diagonal, level[up], upright], axis=1)]
    )
    slant = np.array([0.3, 1.2])
    lengths = np.repeat([1.0, np.hypot(*slant), np.hypot(1.3, 1.2)], n * n) / n
    steps = np.array([[[1, 0], [0, 1], [-1, -1]], [[1, 1], [-1, 0], [0, -1]]])
    return Triangles(corners, edges, lengths, np.zeros(2 * n * n), np.repeat(steps, n * n, axis=0))


EXACT = np.array(
    [[1.2 + 0.3**2 / 1.2, -0.3 / 1.2], [-0.3 / 1.2, 1 / 1.2]]
)  # energies of du and dv on one parallelogram


@pytest.mark.parametrize("order", [1, 2, 5])
@pytest.mark.parametrize("n", [1, 3], ids=["one vertex", "nine vertices"])
def test_forms_remain_what_they_are(n, order):
    random, triangles = np.random.default_rng(0), torus(n)
    for _ in range(3 if n == 1 else 2):
        triangles = halved(triangles, random.random(len(triangles.corners)) < 0.3)
        triangles = with_layers(triangles, random.integers(0, 4, triangles.corners.max() + 1) // 2)
        assert (triangles.classes.sum(axis=1) == 0).all()
        assert (np.bincount(triangles.edges.ravel()) == 2).all()
        assert areas(triangles.sides).sum() == pytest.approx(1.2, rel=1e-13)
        assert np.abs(vertex_exponents(triangles) - 1).max() < 1e-9
        solved = _native.solve_level(*surface_of_triangles(triangles), 2, order, 1, None)
        assert np.abs(solved.energies.gram[0] - EXACT * n * n).max() < 1e-11 * n * n
        assert (solved.energies.certain[0].diagonal() >= EXACT.diagonal() * n * n).all()
        assert solved.gaps.sum() < 1e-11
