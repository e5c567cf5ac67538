"""The parts of a mesh side by side in the UV square: rectangles on shelves.

Shelf packing: rectangles by falling height, from left to right, a new row where the width is used up; the height of a
row is that of its first. Of a fixed set of widths the one that fits the smallest square is taken. Nothing is rotated,
so that straight boundaries stay horizontal. Same sizes, same layout: ties go by index.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.array_types import Reals
from ..mesh.checks import real_number

WIDTHS = 24  # tried, from the square of the total area upwards
WIDEST = 2.0  # the largest of these widths, in sides of that square
MOST_GAP = 0.3  # share of the side for all gaps of a row: with many parts the margin is less than the given one
GAP_ROUNDS = 4  # the gap is a share of a side that depends on the gap; each round leaves a few per cent of the error


def rows(sizes: Reals, width: float, gap: float) -> tuple[Reals, tuple[float, float]]:
    """((n, 2) lower left corners, (w, h) of the whole): the rectangles of (n, 2) `sizes` on shelves of `width`."""
    order = np.argsort(-sizes[:, 1], kind="stable")
    corners = np.zeros_like(sizes)
    x = y = widest = height = 0.0
    for index in order:
        w, h = sizes[index]
        if x > 0 and x + w > width:
            x, y = 0.0, y + height + gap
            height = 0.0
        corners[index] = x, y
        widest, height = max(widest, x + w), max(height, h)
        x += w + gap
    return corners, (widest, y + height)


def _best_rows(sizes, gap):
    padded = sizes + gap
    square = max(math.sqrt(float(np.prod(padded, axis=1).sum())), float(sizes[:, 0].max()))
    found = [rows(sizes, width, gap) for width in np.geomspace(square, WIDEST * square, WIDTHS)]
    return min(found, key=lambda layout: max(layout[1]))  # the first of equals


def fitting_margin(margin: float, count: int) -> float:
    """The margin, or the largest one for which this number of parts has room."""
    return min(margin, MOST_GAP / math.sqrt(count))


def pack(sizes: ArrayLike, margin: float) -> tuple[Reals, float]:
    """((n, 2) lower left corners, side): rectangles that do not overlap, inside a square of that side.

    sizes : (n, 2) widths and heights; margin : distance of neighbours, as a share of the side. The whole is centred in
    the square. O(n log n).
    """
    sizes, margin = arrays.numbers(sizes, "sizes"), real_number(margin, "margin")
    if not sizes.size:
        return np.zeros((0, 2)), 0.0
    if sizes.ndim != 2 or sizes.shape[1] != 2 or not np.isfinite(sizes).all():
        raise ValueError(f"sizes has the shape {sizes.shape}; (n, 2) finite numbers are needed")
    if not sizes.any():  # all of them points
        return np.zeros_like(sizes), 0.0
    margin = fitting_margin(margin, len(sizes))
    corners, whole = _best_rows(sizes, 0.0)
    for _ in range(GAP_ROUNDS if len(sizes) > 1 else 0):
        corners, whole = _best_rows(sizes, margin * max(whole))
    side = max(whole)
    return corners + (side - np.array(whole)) / 2, side
