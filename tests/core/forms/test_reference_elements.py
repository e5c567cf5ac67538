"""Reference matrices of elements of order p: each entry is the rational number, rounded once."""

from fractions import Fraction

import numpy as np
import pytest
from exact_elements import basis, integrals, stiffness
from holomorph import _native

ORDERS = range(1, 11)


@pytest.mark.parametrize("order", ORDERS)
def test_entries_are_rounded_once(order):
    *found, wedge = _native.reference_element(order)
    for of_side, exact in zip(found, stiffness(order), strict=True):
        for value, number in zip(of_side.ravel(), exact.ravel(), strict=True):
            assert abs(Fraction(value) - number) <= Fraction(2) ** -53 * abs(number)
    by_x, by_y = ([f.derivative(*side) for f in basis(order)] for side in [(1, 0), (0, 1)])
    products, scale = integrals(by_x, by_y)
    exact = ((products - products.T) / scale).astype(float)
    assert np.abs(wedge - exact).max() <= 1e-15 * np.abs(exact).max()


@pytest.mark.parametrize("order", ORDERS)
def test_all_polynomials_are_there(order):
    """As many functions as polynomials of that degree but the constants, and no combination without energy."""
    *stiffness, _ = _native.reference_element(order)
    energy = sum(stiffness)
    assert len(energy) == (order + 1) * (order + 2) // 2 - 1
    sizes = np.sqrt(np.diag(energy))
    assert np.linalg.eigvalsh(energy / np.outer(sizes, sizes))[0] > 1e-3
