"""The maps of a mesh's parts side by side in the UV plane, at one median density.

Tilings come first, from (0, 0) on. They are turned by quarters and moved by whole units alone: by anything else a
texture would break off at their seams. Other maps fill the UV square where there is no tiling, else they lie to the
right of the tilings.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core.array_types import Reals
from ..core.value import quoted
from ..mesh.checks import real_number, whole_number
from ..mesh.surface import Surface
from .automatic_structure import AnyStructure
from .map import Map


@dataclass(frozen=True)
class Arrangement:
    """How maps lie in the UV plane.

    density : factor of UV lengths of other maps than tilings, about the middle of the UV square
    rotation : radians, counter-clockwise, of other maps than tilings
    margin : least distance of parts, in sides of the square that they are packed into
    per_length : UV length for a length on the surface, at density 1; 0 fills the UV square
    quarters : turns of tilings by 90 degrees, counter-clockwise
    """

    density: float = 1.0
    rotation: float = 0.0
    margin: float = 0.02
    per_length: float = 0.0
    quarters: int = 0

    def __post_init__(self) -> None:
        for name in ("density", "rotation", "margin", "per_length"):
            real_number(getattr(self, name), name)
        if not isinstance(self.quarters, numbers.Integral):
            raise ValueError(f"quarters is {quoted(self.quarters)}; a whole number is needed")

    @property
    def _native(self):
        lengths = (float(each) for each in (self.density, self.rotation, self.margin, self.per_length))
        return _native.Arrangement(*lengths, self.quarters % 4)


def square(maps: Sequence[Map], arrangement: Arrangement = Arrangement()) -> _native.Square:
    """The maps of parts, of whichever kinds, packed into a square, each scaled until a UV unit is a unit of length
    where its density is the median one.

    filling : `Arrangement.per_length` with which they fill the UV square; infinite where none has an area
    used : part of the square that they cover, where they do not lie over themselves
    sizes : their widths and heights
    """
    return _native.square(_laid(maps), arrangement._native)


def arranged(maps: Sequence[Map], corners: int, arrangement: Arrangement = Arrangement()) -> Reals:
    """(#C, 2) UVs of a mesh from the maps of its parts; zeros at corners without a map.

    Beside a tiling all values are exact in single precision.
    """
    corners = whole_number(corners, "corners", _corner_count([made.surface for made in maps]))
    return _with_repeated(_native.arranged(_laid(maps), corners, arrangement._native), [made.surface for made in maps])


def arranged_form(
    parts: Sequence[tuple[Surface, AnyStructure]], form: int, corners: int, arrangement: Arrangement = Arrangement()
) -> Reals:
    """(#C, 2) UVs of a mesh: the maps of one form, counted from 0, of parts with their structures; zeros at corners of
    parts that lack it."""
    corners = whole_number(corners, "corners", _corner_count([surface for surface, _ in parts]))
    form, maps = whole_number(form, "form"), []
    for surface, structure in parts:
        if form < structure.form_count:  # their type of coefficients: a complex factor would bend straight boundaries
            uv = structure.uv(np.eye(structure.form_count, dtype=structure.coefficient_type)[form])
            maps.append(_one(surface, uv, structure.quality(uv).median_density))
    return _with_repeated(_native.arranged(maps, corners, arrangement._native), [surface for surface, _ in parts])


def _with_repeated(uv, surfaces):
    """The UVs, at corners that are one with another one of their face, too."""
    for surface in surfaces:
        own, other = surface._origin.repeated.T
        uv[own] = uv[other]
    return uv


def _laid(maps):
    """What the core knows of maps."""
    return [_one(made.surface, made.uv, made.density, made.is_tiled, made.turns) for made in maps]


def _one(surface, uv, density, is_tiled=False, turns=1):
    corners = None if surface.is_whole else surface.corner_index
    return surface._native, surface.area, uv, density, is_tiled, turns, corners


def _corner_count(surfaces):
    """The corners up to the last one of any of the parts."""
    indices = [index for each in surfaces for index in (each.corner_index, each._origin.repeated)]
    return max([int(index.max()) + 1 for index in indices if index.size], default=0)


def unit_length(maps: Sequence[Map], arrangement: Arrangement = Arrangement()) -> float:
    """The length on the surface of a UV unit of `arranged` maps, where the density is the median one; 0 for maps
    without area."""
    return _native.unit_length(_laid(maps), arrangement._native)


def common_length(objects: Sequence[Sequence[Map]], arrangement: Arrangement = Arrangement()) -> float:
    """`Arrangement.per_length` with which the maps of several objects have one size: that of tilings, or the largest
    with which each object fits into the UV square; 0 where none has area."""
    tiled = [made for maps in objects for made in maps if made.is_tiled]
    if tiled:
        unit = unit_length(tiled)
        return 1 / unit if unit > 0 else 0.0
    found = min((square(maps, arrangement).filling for maps in objects), default=math.inf)
    return found if math.isfinite(found) else 0.0


def diagonal(surface: Surface) -> float:
    """The diagonal of the bounding box; for an intrinsic surface, that of a square with its area."""
    if surface.vertices is None:
        return math.sqrt(2 * surface.area)
    # NumPy finds ranges of single columns much faster than of all at once.
    return math.hypot(*(float(np.ptp(column)) for column in surface.vertices.T))


def on_grid(uv: ArrayLike) -> Reals:
    """Rounds (n, 2) UVs to multiples of a power of two that single precision holds, so that differences by whole
    numbers stay exact."""
    return _native.on_grid(uv)
