"""The distortion of UV maps, and which way is up on them: how a texture is turned on the steep part of a surface."""

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
from ..core.value import Value, percent
from .verdicts import Verdict, verdict

UPRIGHT, SIDEWAYS, UPSIDE_DOWN = 15.0, 20.0, 160.0  # degrees: from up at most, from a right angle at most, at least
SLANTED = 25.0  # degrees from up at least: less is hardly seen on a rounded surface

SAID, SAID_SLANTED = 0.1, 0.25  # parts of the area
FRACTIONS = {
    "a tenth": 0.1,
    "a fifth": 0.2,
    "a quarter": 0.25,
    "a third": 1 / 3,
    "half": 0.5,
    "two thirds": 2 / 3,
    "three quarters": 0.75,
    "almost all": 0.95,
}


@dataclass(frozen=True, eq=False, repr=False)
class Direction(Value):
    """How far a map turns a texture. Read-only arrays.

    angle : (#T,) degrees between the gradient of v and what is up on the triangle, up to 180; for a texture that looks
        the same after k-th parts of a full turn, to the nearest of these
    steep : (#T,) area of each triangle that is steep, so that something is up on it; 0 of others
    area : of all triangles
    up : the axis that points up, see `Surface.up`
    turns : k; 1 where the texture has an up
    """

    angle: Reals
    steep: Reals
    area: float
    up: str
    turns: int

    @classmethod
    def of(cls, triangulation: object, uv: Reals, up: str, turns: int = 1) -> Direction:
        """That of (#C, 2) UVs on a native surface with positions."""
        return cls.of_native(_native.direction(triangulation, uv, up, turns), up)

    @classmethod
    def of_native(cls, found: _native.Direction, up: str) -> Direction:
        """That of what the core measured."""
        return cls(found.angle, found.steep, found.area, up, found.turns)

    @property
    def of_core(self) -> _native.Direction:
        """The core's own value."""
        return _native.Direction(self.angle, self.steep, self.area, self.turns)

    def of_copy(self, scale: float) -> Direction:
        """That of the same map on a copy of the surface, whose lengths are multiplied by `scale`."""
        return replace(self, steep=arrays.frozen(self.steep * scale**2), area=self.area * scale**2)

    @cached_property
    def steep_part(self) -> float:
        """Part of the area that is steep."""
        return float(self.steep.sum()) / self.area if self.area > 0 else 0.0

    @cached_property
    def upright_part(self) -> float:
        """Part of the steep area where the texture stands upright, within 15 degrees; 1 where nothing is steep."""
        return self._part(self.angle < UPRIGHT) if self.steep_part > 0 else 1.0

    @cached_property
    def sideways_part(self) -> float:
        """Part of the steep area where it lies on its side, within 20 degrees."""
        return self._part(np.abs(self.angle - 90) <= SIDEWAYS)

    @cached_property
    def upside_down_part(self) -> float:
        """Part of the steep area where it stands on its head, within 20 degrees."""
        return self._part(self.angle >= UPSIDE_DOWN)

    @cached_property
    def slanted_part(self) -> float:
        """Part of the steep area where it does neither, and leans by 25 degrees or more."""
        return self._part(self.angle >= SLANTED) - self.sideways_part - self.upside_down_part

    @property
    def words(self) -> str:
        """How much of the steep area is upside down, or lies on its side, such as "a fifth is upside down"; where that
        is less than a tenth of the whole area, how much is slanted; "" where that is less than a quarter of it."""
        part, name = max((self.upside_down_part, "upside down"), (self.sideways_part, "sideways"))
        least = SAID
        if part * self.steep_part < least:
            part, name, least = self.slanted_part, "slanted", SAID_SLANTED
        if part * self.steep_part < least:
            return ""
        return f"{min(FRACTIONS, key=lambda text: abs(FRACTIONS[text] - part))} is {name}"

    def _part(self, flags):
        return float(self.steep[flags].sum() / self.steep.sum()) if self.steep_part > 0 else 0.0

    def _facts(self):
        parts = {"upright": self.upright_part, "sideways": self.sideways_part, "upside down": self.upside_down_part}
        return [f"{percent(part)} {name}" for name, part in parts.items()]


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
