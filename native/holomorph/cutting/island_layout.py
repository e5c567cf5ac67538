"""Maps in islands that lie beside each other."""

from __future__ import annotations

from dataclasses import dataclass

from .. import _native
from ..core.array_types import Integers, Reals
from ..core.value import Value, counted
from ..mesh.surface import Surface
from ..quality.appearance import cost
from ..quality.quality import Quality


@dataclass(frozen=True, eq=False, repr=False)
class Islands(Value):
    """A map in islands that lie beside each other, one unit of length on the surface a UV unit. Read-only arrays.

    uv : (#C, 2)
    seams : (#S, 2) vertices of the edges where the UVs jump
    count : of the islands
    soft_length, hard_length : of the seams across the smooth, and along hard edges that hide them, over the square root
        of the surface's area
    quality : `Quality`, also of how far islands lie over themselves
    evenness : from 0, conformal, to 1: how far squares of one size were preferred to angles
    """

    uv: Reals
    seams: Integers
    count: int
    soft_length: float
    hard_length: float
    quality: Quality
    evenness: float

    @classmethod
    def of(cls, found: _native.Islands, surface: Surface) -> Islands:
        """Those that the core found."""
        quality = Quality._of(found.quality, surface._native, surface.up)
        lengths = found.soft_length, found.hard_length
        return cls(found.uv, found.seams, found.count, *lengths, quality, found.evenness)

    @property
    def cost(self) -> float:
        """The cost to the eye, see `appearance.cost`."""
        return cost(self.quality, 0, self.soft_length, self.hard_length)

    def _facts(self):
        return [counted(self.count, "island"), *self.quality._facts()]
