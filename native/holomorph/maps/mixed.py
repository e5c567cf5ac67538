"""A map of a part in pieces that lie side by side, some with whole tiles, the rest in flat islands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Reals
from ..core.value import Value, counted
from ..mesh.surface import Surface
from ..quality.appearance import cost
from ..quality.quality import Quality
from ..tiling.tilings import Tiling, vertices_of


@dataclass(frozen=True, eq=False, repr=False)
class Mixed(Value):
    """A map whose pieces, cut along hard edges, are mapped each in its own way. All arrays are read-only.

    uv : (#C, 2) UVs: one tile of the texture is the unit square. Those of the tilings may be moved by integers only
    tilings : of the pieces that have one, each with the UVs of its own corners; their vertices are those of the part
    seams : (#S, 2) vertices of the edges where the UVs jump
    quality : `Quality`, with the triangles of one piece after those of another
    evenness : from 0, conformal, to 1: how far squares of one size were preferred to angles
    soft_length, hard_length : of the seams across the smooth, and along hard edges that hide them, over the square root
        of the surface's area
    """

    uv: Reals
    tilings: tuple[Tiling, ...]
    seams: Integers
    quality: Quality
    evenness: float
    soft_length: float
    hard_length: float

    @classmethod
    def of_core(cls, made: _native.Mixed, uv: Reals, quality: Quality, surface: Surface) -> Mixed:
        """The one that the core made of a connected surface."""
        tilings = tuple(Tiling.of_core(each, surface) for each in made.tilings)
        return cls(
            uv, tilings, vertices_of(surface, made.seams), quality, made.evenness, made.soft_length, made.hard_length
        )

    @property
    def cost(self) -> float:
        """The cost to the eye, see `appearance.cost`."""
        cones = sum(len(tiling.cones) for tiling in self.tilings)
        return cost(self.quality, len(self.poles), self.soft_length, self.hard_length, cones)

    def _facts(self):
        return [counted(len(self.tilings), "tiling"), *self.quality._facts()]

    @property
    def poles(self) -> Integers:
        """(k,) vertices, of all tilings."""
        return arrays.frozen(np.concatenate([tiling.poles for tiling in self.tilings]))
