"""The cost of a map to the eye: what is as bad as what, as it was judged on pictures."""

import math
from types import SimpleNamespace

import pytest
from holomorph.quality.appearance import TURN, cost


def quality(density_ratio=1.0, shear=1.0, flipped=0.0, overlapping=0.0):
    lost = {"flipped_part": flipped, "overlapping_part": overlapping}
    return SimpleNamespace(density_ratio=density_ratio, mean_angle=shear, direction=None, **lost)


def test_squares_of_one_to_two_are_as_bad_as_these():
    squares = cost(quality(density_ratio=4.0))
    assert cost(quality(shear=1.7)) == pytest.approx(squares, rel=0.05)
    assert cost(quality(), soft_seams=2.8) == pytest.approx(squares, rel=0.05)
    assert cost(quality(), poles=46) == pytest.approx(squares, rel=0.05)
    assert TURN * math.radians(27) == pytest.approx(squares, rel=0.05)


def test_what_cannot_be_used_is_worse():
    squares = cost(quality(density_ratio=4.0))
    assert cost(quality(flipped=0.1)) > squares < cost(quality(overlapping=0.1))
    assert cost(quality(density_ratio=math.inf)) == cost(quality(density_ratio=math.nan)) == math.inf
    assert 0 < cost(quality(), hard_seams=2.8) < 0.1 * squares
