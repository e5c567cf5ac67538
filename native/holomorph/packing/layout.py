"""Where maps lie in the plane, and how much room parts have beside each other in the UV square."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from .. import _native
from ..mesh.checks import checked_uv, real_number
from ..mesh.surface import Surface


def fitting_margin(margin: float, count: int) -> float:
    """The margin, or the largest one for which this number of parts has room."""
    return _native.fitting_margin(margin, count)


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
    uv = checked_uv(uv, surface)
    return Frame(*_native.frame(surface._native, uv, rotation=real_number(rotation, "rotation"), threads=0))
