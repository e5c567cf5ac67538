"""Period matrices that are given in place of surfaces, as exact as they say."""

import pickle

import numpy as np
import pytest
from holomorph import conformally_equivalent
from holomorph.forms.certificate import PeriodMatrix, distance_within
from holomorph.moduli.symplectic import siegel_reduction
from known_matrices import BOLZA


def test_the_error_stays_with_the_matrix():
    omega = PeriodMatrix.of(BOLZA, 1e-9)
    assert omega.error > 0 and not omega.flags.writeable
    reduced, copied = siegel_reduction(omega).period_matrix, pickle.loads(pickle.dumps(omega))
    for same in (reduced, copied, -omega.conj(), omega[::-1, ::-1]):
        assert same.error == omega.error


def test_a_matrix_is_as_exact_as_it_is_symmetric():
    exact = BOLZA
    skew = np.array(exact)
    skew[0, 1] += 1e-9
    assert 1e-10 < conformally_equivalent(exact, skew).tolerance < 1e-8


@pytest.mark.parametrize("apart", [1e-12, 1e-10, 1e-9])
def test_either_side_of_a_matrix_may_be_the_exact_one(apart):
    """[[i, x], [x, i]] is i + x on the diagonal: 2 asinh(x / 4) from the middle, once for each of both matrices."""
    skew = np.array([[1j, apart], [0, 1j]])
    tolerance = conformally_equivalent(skew, skew).tolerance
    assert 4 * np.arcsinh(apart / 4) <= tolerance < 2 * apart


@pytest.mark.parametrize("change", [1e-6, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("tau", [1j, 0.3 + 1.7j, -0.4 + 0.9j])
def test_the_farthest_torus(tau, change):
    """Im tau less a part of itself: further up the half-plane, or to a side, is not so far."""
    found = distance_within(np.array([[tau]]), np.array([[change * tau.imag]]))
    assert found == pytest.approx(-np.log(1 - change), rel=1e-9)


def test_no_bound_where_a_torus_may_be_none():
    assert distance_within(np.array([[1j]]), np.array([[1.0]])) == np.inf
