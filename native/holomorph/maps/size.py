"""How large squares are, over all parts of all objects: what is wanted, and how far whole tiles may miss it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from ..core.value import quoted
from ..mesh.checks import real_number
from ..mesh.surface import Surface
from .map import Map

LEAST_TILES, TILES_PER_HANDLE = 100, 64  # over the largest part, by default
LIKE_SIZE = 1.095  # largest over smallest median density of tilings, for parts whose squares have one size
TRIES = 4  # numbers of tiles, until the median density is the wanted one
TOLERANCE = 0.2  # of a density that is given, a tenth of lengths: less is seen of that than of a seam

Window: TypeAlias = tuple[float, float]  # least and largest median density, over the wanted one


@dataclass(frozen=True)
class SizePolicy:
    """The size of squares that is asked for. One part leads: its median density is then that of all others.

    density : tiles per unit of area
    tries : numbers of tiles that are tried on the leading part
    tolerance : relative amount by which its median density may differ from the wanted one; None for any, and 0 where no
        part leads, as other meshes have that density
    window : of the other parts, over the density of the leading one; None for the one that holds most of them
    near : relative amount by which tilings may miss it where other maps cost more by as much
    """

    density: float
    tries: int = TRIES
    tolerance: float | None = None
    window: Window | None = None
    near: float = TOLERANCE

    @classmethod
    def of(
        cls,
        parts: Sequence[Surface],
        tiles: float | None = None,
        density: float | None = None,
        tolerance: float = TOLERANCE,
    ) -> SizePolicy:
        """By a number of tiles over all parts, or per unit of area; `usual_density` without either. Raises ValueError
        for both, and for wrong numbers."""
        if tiles is not None and density is not None:
            raise ValueError("give tiles or a density, not both")
        if real_number(tolerance, "density_tolerance") < 0:
            raise ValueError(f"density_tolerance is {quoted(tolerance)}; it cannot be negative")
        if density is not None:
            wanted = real_number(density, "density", positive=True)
            return cls(wanted, tolerance=tolerance, near=min(tolerance, TOLERANCE))
        tiles = tiles and real_number(tiles, "tiles", positive=True)
        area = sum(part.area for part in parts) if tiles else 0.0
        wanted = tiles / area if area > 0 else usual_density(parts)
        return cls(wanted, 1 if tiles is None else TRIES)

    def takes(self, size: float) -> bool:
        """Whether the leading part may have this median density, over the wanted one."""
        return self.tolerance is None or abs(size - 1) <= self.tolerance


def usual_density(parts: Sequence[Surface]) -> float:
    """Tiles per unit of area by default: 100, or 64 for each handle, over the largest part. 0 where none has area."""
    largest = max(parts, key=lambda part: part.area, default=None)
    if largest is None or not largest.area > 0:
        return 0.0
    return max(LEAST_TILES, TILES_PER_HANDLE * largest.genus) / largest.area


def relative_size(made: Map, density: float) -> float:
    """The median density over the wanted one."""
    return made.density / density if density > 0 else 1.0


def is_in(window: Window, size: float) -> bool:
    """Whether a median density, over the wanted one, is in a window."""
    return window[0] <= size <= window[1]


def window_around(low: float = LIKE_SIZE**-0.5) -> Window:
    """The window from `low` on; by default the one in whose middle the wanted density is."""
    return low, low * LIKE_SIZE


def best_window(sizes: Sequence[Sequence[float]], weights: Sequence[float]) -> Window:
    """The window with the wanted density, 1, that holds one of the `sizes` of most parts by their weights; of equal
    ones the one whose middle is nearest to it."""
    tried = [window_around()]
    tried += [window_around(size) for each in sizes for size in each if 1 / LIKE_SIZE <= size <= 1]
    tried += [window_around(size / LIKE_SIZE) for each in sizes for size in each if 1 <= size <= LIKE_SIZE]

    def held(window):
        weight = sum(w for each, w in zip(sizes, weights) if any(is_in(window, size) for size in each))
        return weight, -abs(math.log(window[0] * window[1]))

    return max(tried, key=held)


def nearest(tilings: Sequence[Map], density: float) -> Map:
    """The map whose median density is nearest to the wanted one."""
    return min(tilings, key=lambda made: abs(relative_size(made, density) - 1))
