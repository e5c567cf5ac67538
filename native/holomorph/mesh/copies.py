"""Parts that are copies of each other: moved, turned about the vertical and scaled. One map does for all of them."""

import math
from bisect import bisect_left, bisect_right, insort
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..core.array_types import Progress, Reals
from ..core.progress import tell
from .surface import Surface

SINGLE = 2.0**-22  # rounding of differences of coordinates in single precision, relative to the largest coordinate
NEAR = 1.001  # times the rounding of two names, for that of the sums themselves
AT_ONCE = 256  # parts between two looks at whether to go on
MOST_ROUNDING = 1e-3  # over the mean edge: parts so far from the origin are no longer known to be alike


@dataclass(frozen=True)
class Copy:
    """first : index of the part that stands for a part, which may be itself; scale : lengths over those of that one"""

    first: int
    scale: float = 1.0


def copies(parts: Sequence[Surface], progress: Progress | None = None) -> list[Copy]:
    """The `Copy` that each part is: of the first part with the same polygons and triangles, numbered alike, whose
    lengths and heights are the same but for one factor and the rounding of single precision. O(#C + n log n).

    progress : is asked whether to go on"""
    found, alike = [], {}
    for k, part in enumerate(parts):
        if k % AT_ONCE == AT_ONCE - 1:
            tell(progress, 0.0, "copies")
        shape = _Shape.of(part)
        known = alike.setdefault((part.face_offsets.tobytes(), part.triangles.tobytes()), _Known())
        copy = known.copy_of(shape)
        if copy is None:
            known.add(k, shape)
        found.append(copy or Copy(k))
    return found


@dataclass
class _Known:
    """Shapes of the same triangles, none a copy of another. names : their `_Shape.name`, sorted, and their indices;
    shapes : by index; rounding : the largest of their names"""

    names: list[tuple[float, int]] = field(default_factory=list)
    shapes: dict[int, "_Shape"] = field(default_factory=dict)
    rounding: float = 0.0

    def add(self, index, shape):
        self.shapes[index] = shape
        if shape.size > 0:
            insort(self.names, (shape.name, index))
            self.rounding = max(self.rounding, shape.rounding / shape.size)

    def copy_of(self, shape):
        """The `Copy` that a shape is of the first of these, or None."""
        if not shape.size > 0:
            return None
        reach = NEAR * (self.rounding + shape.rounding / shape.size)
        low, high = (shape.name - reach, -1), (shape.name + reach, math.inf)
        near = self.names[bisect_left(self.names, low) : bisect_right(self.names, high)]
        scales = ((index, shape.scale_of(self.shapes[index])) for index in sorted(index for _, index in near))
        return next((Copy(index, scale) for index, scale in scales if scale), None)


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

    @cached_property
    def name(self):
        """A mean of lengths and heights over the size, weighted at random but always alike: those of two copies differ
        by no more than their `rounding`, over their sizes, and hardly two others have the same."""
        values = np.concatenate([self.lengths, self.heights])
        weights = np.sin(np.arange(1, len(values) + 1) ** 2)
        return float(weights @ values / (np.abs(weights).sum() * self.size))

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
