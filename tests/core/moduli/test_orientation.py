"""Conformal maps keep the orientation, on surfaces that are their own mirror images too, and tell their errors."""

import map_pairs
import pytest
from holomorph import conformal_map, conformal_structure
from solved import surface_of


@pytest.mark.parametrize("number", [k * 9 + k // 6 for k in range(12)])
def test_symmetric_pairs(number):
    """All shapes and all kinds of images; `python tests/support/map_pairs.py` tries 200."""
    found = map_pairs.measured(map_pairs.symmetric_pair(number))
    assert found.verdict in ("equivalent", "indistinguishable")
    assert found.kept > 0.95
    assert found.folded < 0.03  # ears, whose corners are all on the boundary


@pytest.mark.parametrize("number", range(20))
def test_random_pairs(number):
    pair = map_pairs.random_pair(number)
    found = map_pairs.measured(pair)
    assert found.kept > 0.9  # creases are seen from one side only
    assert found.folded < 0.01
    if pair.expected:
        assert found.verdict == pair.expected
        assert 0.25 < found.error / found.residual < 4  # the residual tells the error by its size


@pytest.mark.parametrize("name", ["tube", "square ring", "pants"])
def test_the_error_of_the_periods_is_told(name):
    a, b = (conformal_structure(surface_of(map_pairs.SYMMETRIC[name](seed))) for seed in (0, 4))
    found = conformal_map(a, b, tolerance=0.05)
    assert found.residual >= found.equivalence.residual > 0


def test_what_is_folded_is_told():
    """Ears of a hole's boundary have images with next to no area."""
    assert len(conformal_map(*map_pairs.symmetric_pair(0).structures()).folded) == 0
    found = conformal_map(*map_pairs.symmetric_pair(7).structures(), tolerance=map_pairs.TOLERANCE)
    assert len(found.folded) > 0 and f"{len(found.folded)} folded" in repr(found)
