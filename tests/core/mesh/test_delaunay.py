"""Intrinsic Delaunay triangulations: which edges are flipped, and what of a flat triangle is kept."""

import numpy as np
import pytest
from exact_metrics import torus_of_two
from holomorph import _native
from thin_meshes import square_with


@pytest.mark.parametrize("angle", 10.0 ** -np.arange(1, 9), ids="{:.0e}".format)
def test_of_both_diagonals_the_shorter_one_is_taken(angle):
    """The parallelograms are nearly rectangles."""
    a, b, cosine = 1.0, 0.8, np.sin(angle)
    short, long = (np.sqrt(a * a + b * b - 2 * s * a * b * cosine) for s in (1, -1))
    for given in (short, long):
        level = _native.solve_level(*torus_of_two([a, b, given]), 2, 1, 1, None)
        assert level.lengths[2] == pytest.approx(short, rel=1e-15)


@pytest.mark.parametrize("height", [4e-8, 6e-8, 1e-7], ids=str)
def test_heights_of_flat_triangles_are_kept(height):
    """Their slack is 1e-14 of a side. A square's modulus feels the height at an upright side, not at a diagonal;
    rounded lengths leave it open to 1e-10 of the side."""
    _, found = square_with(lambda a, b: (a + b) / 2 + height * np.array([b[1] - a[1], a[0] - b[0], 0]), (6, 11))
    assert found.modulus == pytest.approx(1, abs=1e-10)
