"""Theta constants, of which Igusa's invariants are made: known ones, and identities."""

import numpy as np
import pytest
from curve_periods import period_matrix_of
from curves import NATURAL, theta_sizes, thomae_sizes
from holomorph import siegel_reduction
from holomorph.moduli.symplectic import even_theta_constants


@pytest.mark.parametrize("name", NATURAL)
def test_curves_have_the_theta_constants_of_their_branch_points(name):
    points = NATURAL[name]
    assert theta_sizes(period_matrix_of(points)) == pytest.approx(thomae_sizes(points), abs=1e-8)


@pytest.mark.parametrize("name", [name for name, points in NATURAL.items() if len(points) > 6])
def test_theta_constants_of_curves(name):
    """One of the 36 vanishes, to the error that follows from that of the periods, and no other."""
    omega = siegel_reduction(period_matrix_of(NATURAL[name])).period_matrix
    sizes = np.sort(np.abs(even_theta_constants(omega)))
    assert sizes[0] < 1e-8 < 1e-3 < sizes[1]


def test_theta_constants_of_tori():
    """Jacobi: theta_3^4 = theta_2^4 + theta_4^4; and theta_3(i) = pi^(1/4) / Gamma(3/4)."""
    assert abs(even_theta_constants(np.array([[1j]]))[0] - 1.0864348112133080) < 1e-14
    for height in np.random.default_rng(0).uniform(0.9, 3, 300):
        three, four, two = even_theta_constants(np.array([[1j * height]])).real
        assert abs(three**4 - two**4 - four**4) < 1e-14
