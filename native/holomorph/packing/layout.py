"""The parts of a mesh side by side in the UV square: rectangles on shelves.

Shelf packing: rectangles by falling height, from left to right, a new row where the width is used up; the height of a
row is that of its first. Of a fixed set of widths the one that fits the smallest square is taken. Nothing is rotated,
so that straight boundaries stay horizontal. Same sizes, same layout: ties go by index.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Reals
from ..mesh.checks import complex_number, real_number
from ..mesh.surface import Surface


def rows(sizes: Reals, width: float, gap: float) -> tuple[Reals, tuple[float, float]]:
    """((n, 2) lower left corners, (w, h) of the whole): the rectangles of (n, 2) `sizes` on shelves of `width`."""
    return _native.on_shelves(sizes, real_number(width, "width"), real_number(gap, "gap"))


def fitting_margin(margin: float, count: int) -> float:
    """The margin, or the largest one for which this number of parts has room."""
    return _native.fitting_margin(margin, count)


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
    return _native.pack(sizes, margin)


@dataclass(frozen=True)
class Frame:
    """The bounding box of a map in the complex plane u + i v, by its lower left and upper right corner, and the sum of
    the areas of its triangles, whichever way they lie."""

    low: complex
    high: complex
    area: float


def frame(surface: Surface, uv: ArrayLike, rotation: float = 0.0) -> Frame:
    """The `Frame` of a (#C, 2) map of the surface's polygon corners, rotated by `rotation` (radians, counter-clockwise)
    about 0.

    Raises ValueError for another shape of `uv`, or a rotation that is not finite.
    Source: elementary.

    Examples
    --------
    >>> square = holomorph.Surface([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> uv = square.vertices[square.corner_vertices][:, :2]
    >>> print(holomorph.frame(square, uv, rotation=np.pi / 2).area)
    2.0
    """
    uv = _corners(uv, len(surface.corner_vertices))
    return Frame(*_native.frame(surface._native, uv, rotation=real_number(rotation, "rotation"), threads=0))


def place(
    uv: ArrayLike,
    factor: complex,
    origin: complex,
    target: complex,
    placed: Reals,
    rows: ArrayLike | None = None,
) -> None:
    """Writes ``factor * (z - origin) + target`` for every z = u + i v of a map into `placed`: corners with the same u
    or v keep them the same where `factor` is real.

    Parameters
    ----------
    uv : (#C, 2) reals
    factor, origin, target : complex numbers
    placed : (n, 2) float64, C-contiguous: changed
    rows : (#C,) integers below n, all different: the row of `placed` of each corner; None where it is the corner's own

    Raises ValueError for arrays of other shapes or types, and for rows outside of `placed`.
    Source: elementary.

    Examples
    --------
    >>> placed = np.zeros((2, 2))
    >>> holomorph.place([(0, 0), (1, 0)], factor=2j, origin=0, target=1, placed=placed)
    >>> print(placed)
    [[1. 0.]
     [1. 2.]]
    """
    if not (isinstance(placed, np.ndarray) and placed.dtype == np.float64 and placed.flags.carray):
        raise ValueError("placed must be a writable C-contiguous array of float64")
    if placed.ndim != 2 or placed.shape[1] != 2:
        raise ValueError(f"placed has the shape {placed.shape}; (rows, 2) is needed")
    uv = _corners(uv, len(placed) if rows is None else len(rows))
    rows = np.empty(0, np.int32) if rows is None else np.ascontiguousarray(rows, np.int32)
    if rows.size and (rows.min() < 0 or rows.max() >= len(placed)):
        raise ValueError(f"rows has an entry outside of 0 to {len(placed) - 1}")
    if len(uv):
        numbers = (complex_number(*given) for given in ((factor, "factor"), (origin, "origin"), (target, "target")))
        _native.place(uv, *numbers, rows, placed, threads=0)


def _corners(uv, count):
    uv = arrays.numbers(uv, "uv")
    if uv.shape != (count, 2):
        raise ValueError(f"uv has the shape {uv.shape}; ({count}, 2) is needed")
    return uv
