"""How large squares are, over all parts of all objects: what is wanted, and how far whole tiles may miss it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from typing import TypeAlias

from .. import _native
from ..mesh.checks import real_number
from ..mesh.surface import Surface
from ..tiling.options import part_of

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
    tries: int
    tolerance: float | None
    window: Window | None
    near: float

    @classmethod
    def of(
        cls,
        parts: Sequence[Surface],
        tiles: float | None = None,
        density: float | None = None,
    ) -> SizePolicy:
        """By a number of tiles over all parts, or per unit of area; without either 100 tiles, or 64 for each handle,
        over the largest part. Raises ValueError for both, and for wrong numbers."""
        if tiles is not None and density is not None:
            raise ValueError("give tiles or a density, not both")
        if density is not None:
            wanted = real_number(density, "density", positive=True)
            return cls.of_core(_native.SizePolicy.of_density(wanted, TOLERANCE))
        tiles = tiles and real_number(tiles, "tiles", positive=True)
        return cls.of_core(_native.SizePolicy.of_tiles([part_of(part) for part in parts], tiles or 0.0))

    @classmethod
    def of_core(cls, size: _native.SizePolicy) -> SizePolicy:
        """That of the core."""
        return cls(size.density, size.tries, size.tolerance, size.window, size.near)

    @property
    def core(self) -> _native.SizePolicy:
        """The core's own value."""
        return _native.SizePolicy(*astuple(self))
