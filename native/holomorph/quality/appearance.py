"""How far a map is from one on which a texture looks as on flat paper, as one number: 0 is perfect; uv/appearance.h."""

from typing import TYPE_CHECKING

from .. import _native
from ..core.array_types import Complexes, Progress

if TYPE_CHECKING:
    from .quality import Quality

SHEAR, FLIPPED, ROUNDING = (_native.prices[name] for name in ("shear", "flipped", "rounding"))
SEAM, HARD_SEAM, POLE, CONE, TURN = (_native.prices[name] for name in ("seam", "hard_seam", "pole", "cone", "turn"))
SIDEWAYS, ON_ITS_HEAD = (_native.prices[name] for name in ("sideways", "on_its_head"))


def cost(quality: "Quality", poles: int = 0, soft_seams: float = 0.0, hard_seams: float = 0.0, cones: int = 0) -> float:
    """The cost of a map to the eye; infinite for one with collapsed parts.

    poles, cones : how many
    soft_seams, hard_seams : lengths over the square root of the area
    """
    marks = _native.cost_of_marks(soft_seams, hard_seams, poles, cones)
    return of_squares(quality) + of_direction(quality) + marks


def of_squares(quality: "Quality") -> float:
    """The part of the cost that is of squares that differ, are sheared, flipped or lie over each other."""
    overlapping = quality.overlapping_part or 0.0
    return _native.cost_of_squares(quality.density_ratio, quality.mean_angle, quality.flipped_part, overlapping)


def of_overlaps(quality: "Quality") -> float:
    """The part of the cost that is of what lies over itself: a texture that tiles does not show it."""
    return _native.cost_of_overlaps(quality.overlapping_part or 0.0)


def of_direction(quality: "Quality") -> float:
    """The part of the cost that is of a texture that does not stand upright, by the sine of the angle."""
    direction = quality.direction
    return 0.0 if direction is None else _native.cost_of_direction(direction.angle, direction.steep, direction.area)


def overlapping_part(curve: Complexes, progress: Progress | None = None) -> float:
    """The part of the region around which closed curves wind that they wind around more than once: 0 where the map that
    they bound lies beside itself nowhere. See uv/quality.h.

    curve : (n, 2) complex ends of directed edges, which make closed curves
    progress : is asked whether to go on
    """
    return _native.overlapping_part(curve, progress)
