"""Surfaces that are nearly equivalent, by exact periods: told apart down to the rounding of a comparison."""

import numpy as np
import pytest
from equivalence import gram_of, random_symplectic, symplectic_unit
from holomorph import _native


def compared(a, b):
    lattices = (_native.PeriodLattice.closed(gram, symplectic_unit(len(gram) // 2)) for gram in (a, b))
    return _native.compare(*lattices, allowed=0.0, needed=0.0, progress=None)


@pytest.mark.parametrize("stretch", [1e-3, 1e-5, 1e-7, 1e-8], ids="{:.0e}".format)
def test_tori_are_told_apart(stretch):
    """The periods are i y and i y (1 + x): the best map stretches one direction by 1 + x (Teichmueller)."""
    a, b = (gram_of(np.array([[0.2 + 1.3j * factor]])) for factor in (1.0, 1.0 + stretch))
    S = random_symplectic(1, 0)
    found = compared(a, S @ b @ S.T)
    assert found.verdict == "not_equivalent"
    assert 0 < found.margin <= np.log1p(stretch) * (1 + 1e-6)


def test_rounding_is_no_difference():
    for seed in range(20):
        y = np.random.default_rng(seed).uniform(0.5, 2)
        gram = gram_of(np.array([[0.2 + 1j * y]]))
        S = random_symplectic(1, seed)
        assert compared(gram, S @ gram @ S.T).verdict == "indistinguishable"
