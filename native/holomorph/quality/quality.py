"""The distortion of UV maps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cache, cached_property

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Flags, Reals
from ..core.value import Value
from .direction import Direction
from .verdicts import Verdict, verdict


@dataclass(frozen=True, eq=False, repr=False)
class Quality(Value):
    """Distortion of a UV map per triangle, s1 >= s2 its singular values.

    angle: (#T,) s1 / s2 (1 where a triangle has no area, infinite where it has collapsed or a UV is not finite); area:
    (#T,) s1 s2, UV area per surface area; flipped: (#T,) bool; weights: (#T,) areas on the surface; mean_angle: mean
    of s1 / s2 over the area, each triangle with 10 at most, so that none decides it alone; density_ratio: 95 % over
    5 % quantile of s1 s2 by area; median_density: its 50 % quantile; size_range: of the sides of squares, the root of
    density_ratio; flipped_part, lost_part: parts of the area that are flipped, and that are flipped or have collapsed;
    overlapping_part: of a map with a free boundary, the part of its region in the plane that it covers more than once;
    None for others; unseen_angle: of an evened map, what evening added to `mean_angle`, as far as that is not seen;
    direction: `Direction`, None where nothing is to be upright.
    """

    _unpickled = ("_triangulation",)

    angle: Reals
    area: Reals
    flipped: Flags
    weights: Reals
    mean_angle: float
    density_ratio: float
    median_density: float
    flipped_part: float
    lost_part: float
    _triangulation: object
    overlapping_part: float | None = None
    unseen_angle: float = 0.0
    direction: Direction | None = None

    @classmethod
    def of(cls, triangulation: object, uv: Reals, threads: int) -> Quality:
        """The `Quality` of (#C, 2) UVs on a native surface."""
        return cls._of(_native.quality(triangulation, uv, threads), triangulation)

    @classmethod
    def _of(cls, found, triangulation, up="Z"):
        direction = found.direction and Direction.of_native(found.direction, up)
        values = {name: getattr(found, name) for name in cls._names()}
        return cls(**values | {"direction": direction}, _triangulation=triangulation)

    @classmethod
    def joined(cls, qualities: Sequence[Quality], densities: ArrayLike) -> Quality:
        """The `Quality` of several maps together, each scaled until its median density is the given one. Triangles of
        one map follow those of the other.

        densities : (n,); maps without area keep theirs
        """
        if len(qualities) == 1:
            return qualities[0].of_density(densities[0])
        up = next((each.direction.up for each in qualities if each.direction), "Z")
        return cls._of(_native.joined([each._of_core for each in qualities], densities), None, up)

    @property
    def _of_core(self):
        values = {name: getattr(self, name) for name in self._names()}
        return _native.Quality(**values | {"direction": self.direction and self.direction.of_core})

    @classmethod
    @cache
    def _names(cls):
        return [field.name for field in fields(cls) if not field.name.startswith("_")]

    def upright(self, uv: Reals, up: str, turns: int = 1) -> Quality:
        """The same with the `Direction` of these UVs, where the surface has positions."""
        if self._triangulation.intrinsic:
            return self
        return replace(self, direction=Direction.of(self._triangulation, uv, up, turns))

    def of_copy(self, scale: float) -> Quality:
        """The `Quality` of the same map on a copy of the surface, whose lengths are multiplied by `scale`."""
        direction = self.direction and self.direction.of_copy(scale)
        weights = arrays.frozen(self.weights * scale**2)
        return replace(self._scaled(scale**-2), weights=weights, direction=direction)

    def of_density(self, density: float) -> Quality:
        """The `Quality` of the map scaled until its median density is this one; a map without area keeps its own."""
        return self._scaled(density / self.median_density if self.median_density > 0 else 1.0)

    def _scaled(self, factor):
        area = arrays.frozen(self.area * factor)
        return replace(self, area=area, median_density=self.median_density * factor)

    def _facts(self):
        lost = [(self.flipped, "flipped"), (self.collapsed, "collapsed")]
        counts = [f"{count} {name}" for flags, name in lost if (count := np.count_nonzero(flags))]
        return [f"size range {self.size_range:.4g}", f"angle distortion {self.mean_angle:.4g}", *counts]

    @property
    def collapsed(self) -> Flags:
        """(#T,) bool: the map leaves a triangle with area next to none."""
        return np.isinf(self.angle)

    @property
    def size_range(self) -> float:
        """How many times as long as the 5 % smallest squares the 5 % largest are at least."""
        return math.sqrt(self.density_ratio)

    @cached_property
    def verdict(self) -> Verdict:
        """The `Verdict` on the map."""
        return verdict(self)
