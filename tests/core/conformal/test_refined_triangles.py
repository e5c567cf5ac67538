"""Triangles cut at midpoints of sides: areas in exact fractions, and what rounding makes of medians."""

from fractions import Fraction

import numpy as np
import pytest
from exact_metrics import UNIT, exact, growth
from holomorph.forms.refined_triangles import Triangles, areas, refined

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


def exact_squares(lengths, sides):
    """(#T, 3) the exact squares of what `sides` are: sides of the triangle, halves of them, and medians."""
    a, b, c = exact(lengths) * exact(lengths)
    medians = [(2 * (y + z) - x) / 4 for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    known = np.array([a, b, c, a / 4, b / 4, c / 4, *medians])
    return known[np.abs(np.sqrt(known.astype(float)) / sides[:, :, None] - 1).argmin(axis=2)]


@pytest.mark.parametrize("cut", [[0], [1], [2], [0, 2]], ids=str)
@pytest.mark.parametrize("height", HEIGHTS)
def test_energies_grow_by_no_more_than_medians_are_rounded(height, cut):
    """The triangle whose neighbours are cut in four has medians, which rounding makes as wrong as is said of them."""
    parts = []
    for lengths in random_triangles(height, 300):
        pieces = refined(with_neighbours(lengths, 0.0), np.isin(np.arange(-1, 3), cut))
        grown = growth(pieces.sides, exact_squares(lengths, pieces.sides))
        assert (grown <= pieces.errors).all()
        assert np.count_nonzero(pieces.errors) == 2
        parts.append(grown[pieces.errors > 0] / pieces.errors[pieces.errors > 0])
    assert np.max(parts) > NEAR


def test_errors_that_were_there_remain():
    """A piece of what stands for another triangle does so, too: the factors 1 + error multiply."""
    for lengths in random_triangles(1e-4, 100):
        marked = np.array([False, True, False, False])
        without, pieces = (refined(with_neighbours(lengths, error), marked) for error in (0.0, 1e-3))
        exactly = [(1 + Fraction(1e-3)) * (1 + Fraction(growth)) - 1 for growth in without.errors]
        assert all(abs(Fraction(error) - sure) <= 1e-15 for error, sure in zip(pieces.errors, exactly, strict=True))
