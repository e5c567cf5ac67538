"""Whether a tiling takes the place of the balanced map."""

from types import SimpleNamespace

import pytest
from holomorph import choice


def tiling(ratio, sheared, flipped=0.0):
    return SimpleNamespace(
        density_ratio=ratio, quality=SimpleNamespace(capped_mean_angle=sheared, flipped_part=flipped)
    )


@pytest.mark.parametrize(
    ("made", "balanced", "is_better"),
    [
        (tiling(5.0, 1.1), (200.0, 1.1), True),
        (tiling(5.0, 1.1), (None, 1.1), True),  # None where the ratio is infinite
        (tiling(5.0, 1.2), (5.0, 1.1), True),  # as even, and without a seam
        (tiling(5.2, 1.1), (5.0, 1.1), False),
        (tiling(5.0, 1.25), (200.0, 1.1), False),
        (tiling(6.5, 1.45, 0.0135), (1.1e5, 2.0), True),  # a penguin of 200 quads
        (tiling(6.5, 1.45, 0.03), (1.1e5, 2.0), False),
    ],
)
def test_a_tiling_is_to_be_about_as_even_and_hardly_more_sheared(made, balanced, is_better):
    assert choice.is_better(made, *balanced) == is_better


def test_an_even_map_without_seams_is_not_compared():
    for seams in ([], [3]):
        structure = SimpleNamespace(seams=seams)
        asked = [choice.is_worth_a_tiling(structure, ratio) for ratio in (1.9, 2.1, None)]
        assert asked == [bool(seams), True, True]
