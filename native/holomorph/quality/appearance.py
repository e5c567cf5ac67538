"""How far a map is from one on which a texture looks as on flat paper, as one number: 0 is perfect.

The weights were judged by eye on pictures of some thirty meshes beside Smart UV Project. Squares of 1 to 2 side by
side, a size range of 2, are as bad as a mean shear of 1.7, as a seam nearly three times the size of the surface
where it is smooth, or as four dozen poles. A seam along a hard edge, where the light breaks too, is hardly seen. Rows
of squares that turn on their way round a tube by 27 degrees in the mean, as on a lamp shade unrolled, are as bad, too.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .quality import Quality

SHEAR = 2.0  # for 1 more of the mean s1 / s2, where an e-fold density ratio costs 1
FLIPPED = 20.0  # for the whole area
OVERLAPPING, OVERLAPS = 20.0, 0.2  # for the whole map, and for that it does, since it cannot be painted or baked
ROUNDING = 1e-6  # part of the map: less of an overlap is none
SEAM = 0.5  # for a seam as long as the square root of the area, where it is smooth
HARD_SEAM = 0.03  # and along hard edges
POLE = 0.03
SIDEWAYS, ON_ITS_HEAD = 1.0, 0.5  # of a texture, for the whole area, as far as it is steep
CONE = 0.005  # of a tiling that turns: three or five squares meet
TURN = 3.0  # for a radian by which rows of squares that could run round a tube turn away from that, in the mean


def cost(quality: "Quality", poles: int = 0, soft_seams: float = 0.0, hard_seams: float = 0.0, cones: int = 0) -> float:
    """The cost of a map to the eye; infinite for one with collapsed parts.

    poles, cones : how many
    soft_seams, hard_seams : lengths over the square root of the area
    """
    seams = SEAM * soft_seams + HARD_SEAM * hard_seams
    return of_squares(quality) + of_direction(quality) + seams + POLE * poles + CONE * cones


def of_squares(quality: "Quality") -> float:
    """The part of the cost that is of squares that differ, are sheared, flipped or lie over each other."""
    ratio = quality.density_ratio
    if not ratio >= 1 or math.isinf(ratio):
        return math.inf
    return math.log(ratio) + SHEAR * (quality.mean_angle - 1) + FLIPPED * quality.flipped_part + of_overlaps(quality)


def of_overlaps(quality: "Quality") -> float:
    """The part of the cost that is of what lies over itself: a texture that tiles does not show it."""
    overlapping = quality.overlapping_part or 0.0
    return OVERLAPPING * overlapping + OVERLAPS * (overlapping > ROUNDING)


def of_direction(quality: "Quality") -> float:
    """The part of the cost that is of a texture that does not stand upright, by the sine of the angle."""
    direction = quality.direction
    if direction is None or not direction.area > 0:
        return 0.0
    angle = np.radians(direction.angle)
    least = np.where(direction.angle > 90, ON_ITS_HEAD, 0.0)
    minded = least + (SIDEWAYS - least) * np.sin(angle)
    return float(direction.steep @ minded) / direction.area
