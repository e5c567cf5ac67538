"""Theta constants, of which Igusa's invariants are made: known ones, identities, and the errors of bounds."""

from fractions import Fraction

import numpy as np
import pytest
from curve_periods import period_matrix_of
from curves import NATURAL, theta_sizes, thomae_sizes
from holomorph import siegel_reduction
from holomorph.moduli.igusa import even_theta_constants


@pytest.mark.parametrize("name", NATURAL)
def test_curves_have_the_theta_constants_of_their_branch_points(name):
    points = NATURAL[name]
    assert theta_sizes(period_matrix_of(points)) == pytest.approx(thomae_sizes(points), abs=1e-8)


@pytest.mark.parametrize("name", [name for name, points in NATURAL.items() if len(points) > 6])
def test_theta_constants_of_curves(name):
    """One of the 36 vanishes, to the error that follows from that of the periods, and no other."""
    omega = siegel_reduction(period_matrix_of(NATURAL[name])).period_matrix
    found = sorted((abs(value), error) for value, error in even_theta_constants(omega, np.expm1(omega.error)))
    assert found[0][0] <= found[0][1] < 1e-3
    assert all(size > error for size, error in found[1:])


def test_rounding_of_theta_constants():
    """Jacobi: theta_3^4 = theta_2^4 + theta_4^4, in fractions, to the errors."""
    for height in np.random.default_rng(0).uniform(0.9, 3, 300):
        constants = [(Fraction(value.real), error) for value, error in even_theta_constants(np.array([[1j * height]]))]
        (three, _), (four, _), (two, _) = constants
        assert abs(three**4 - two**4 - four**4) <= sum(4 * abs(value) ** 3 * error for value, error in constants)


@pytest.mark.parametrize("change", [1e-5, 1e-3, 1e-1])
def test_errors_of_bounds(change):
    """theta_3(i y) is the sum of exp(-pi n^2 y): the lowest y within the bounds is the farthest."""
    n = np.arange(-9, 10)
    for height in (0.9, 1.5, 2.5):
        value, error = next(even_theta_constants(np.array([[1j * height]]), change))
        farthest = np.exp(-np.pi * n**2 * height * (1 - change)).sum()
        assert 0.6 * error < farthest - value.real <= error


def test_theta_constants_of_a_torus():
    """Jacobi: theta_3^4 = theta_2^4 + theta_4^4; and theta_3(i) = pi^(1/4) / Gamma(3/4)."""
    (three, _), (four, _), (two, _) = even_theta_constants(np.array([[1j]]))
    assert abs(three - 1.0864348112133080) < 1e-14
    assert abs(three**4 - two**4 - four**4) < 1e-14
