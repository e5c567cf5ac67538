"""Parts that are copies of each other: moved, turned about the vertical and scaled. One map does for all of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.array_types import Reals
from .surface import Surface

SINGLE = 2.0**-22  # rounding of differences of coordinates in single precision, relative to the largest coordinate
MOST_ROUNDING = 1e-3  # over the mean edge: parts so far from the origin are no longer known to be alike


@dataclass(frozen=True)
class Copy:
    """first : index of the part that stands for a part, which may be itself; scale : lengths over those of that one"""

    first: int
    scale: float = 1.0


def copies(parts: Sequence[Surface]) -> list[Copy]:
    """The `Copy` that each part is: of the first part with the same polygons and triangles, numbered alike, whose
    lengths and heights are the same but for one factor and the rounding of single precision. O(#C)."""
    found, alike = [], {}
    for k, part in enumerate(parts):
        shape = _Shape.of(part)
        known = alike.setdefault((part.face_offsets.tobytes(), part.triangles.tobytes()), [])
        scale = next(((first, scale) for first, other in known if (scale := shape.scale_of(other))), None)
        if scale is None:
            known.append((k, shape))
        found.append(Copy(*scale) if scale else Copy(k))
    return found


@dataclass(frozen=True)
class _Shape:
    """lengths : (#E,), and their mean; heights : (#V,) above their mean, none of an intrinsic surface; size : root of
    the area; rounding : of the lengths, and of the heights"""

    lengths: Reals
    mean_length: float
    heights: Reals
    size: float
    rounding: float

    @classmethod
    def of(cls, part):
        lengths, size = part._native.edge_lengths, part.area**0.5
        if part.vertices is None:
            return cls(lengths, lengths.mean(), np.empty(0), size, SINGLE * lengths.max())
        heights = part.vertices[:, "XYZ".index(part.up)]
        return cls(lengths, lengths.mean(), heights - heights.mean(), size, SINGLE * np.abs(part.vertices).max())

    def scale_of(self, other):
        """Lengths over those of the other, 0 where it is not a copy. @pre the same triangles"""
        if not (self.size > 0 and other.size > 0) or len(self.heights) != len(other.heights):
            return 0.0
        scale = self.size / other.size
        tolerance = self.rounding + scale * other.rounding
        if (
            tolerance > MOST_ROUNDING * self.mean_length
            or abs(self.mean_length - scale * other.mean_length) > tolerance
        ):
            return 0.0
        pairs = (self.lengths, other.lengths), (self.heights, other.heights)
        return scale if all(np.allclose(own, scale * its, rtol=0, atol=tolerance) for own, its in pairs) else 0.0
