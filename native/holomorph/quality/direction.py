"""Which way is up on a map: how a texture is turned on the steep part of a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Reals
from ..core.value import Value, percent

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

    def under(self, turns: int) -> Direction:
        """That of the same map under a texture that looks the same after k-th parts of a full turn."""
        period = 360 / turns
        angle = np.abs(self.angle - period * np.round(self.angle / period))
        return replace(self, angle=arrays.frozen(angle), turns=turns)

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
