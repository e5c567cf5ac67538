"""Which map of a part is shown first: the balanced one of its forms, or a tiling where that is no less even."""

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .structure import AnyStructure
    from .tiling import Tiling

EVEN = 2.0  # 95 : 5 % ratio of the density below which a map without seams stays: the squares' sizes hardly differ
LESS_EVEN = 1.01  # the ratio of a tiling over that of the balanced map, with which it still takes its place
MORE_SHEARED = 1.1  # the capped mean s1 / s2 of a tiling over that of the balanced map: a few triangles do not decide
MOST_FLIPPED = 0.02  # of its area: what flips is beside branch points, and few are seen

# The poles of the tilings that are tried; the first one that is better is taken. Without any, the map of a ring, such
# as a pipe, is the balanced one, scaled until whole tiles fit around it.
POLES = ("auto", 0)


def is_worth_a_tiling(structure: "AnyStructure", density_ratio: float | None) -> bool:
    """Whether a texture would break off at a seam of the balanced map, or vary in size, where its ratio, None for
    infinite, is large."""
    return len(structure.seams) > 0 or density_ratio is None or density_ratio > EVEN


def is_better(tiling: "Tiling", density_ratio: float | None, capped_mean_angle: float) -> bool:
    """Whether a `Tiling` takes the place of the balanced map with this ratio, None where it is infinite, and angle:
    it has no visible seam, so that it is to be about as even, and hardly more sheared."""
    ratio = math.inf if density_ratio is None else density_ratio
    quality, most_sheared = tiling.quality, MORE_SHEARED * capped_mean_angle
    is_fit = quality.flipped_part < MOST_FLIPPED and quality.capped_mean_angle < most_sheared
    return is_fit and tiling.density_ratio < LESS_EVEN * ratio
