"""The maps of a mesh's parts side by side in the UV plane, at one median density.

Tilings come first, from (0, 0) on. They are turned by quarters and moved by whole units alone: by anything else a
texture would break off at their seams. Other maps fill the UV square where there is no tiling, else they lie to the
right of the tilings.
"""

from __future__ import annotations

import cmath
import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Reals
from ..core.value import quoted
from ..mesh.checks import real_number, whole_number
from ..mesh.surface import Surface
from ..packing.layout import Frame, frame, pack, place, rows
from .automatic_structure import AnyStructure
from .map import SCATTERED, Map

CENTRE = 0.5 + 0.5j  # the middle of the UV square
SINGLE_BITS = 24  # bits of the mantissa of single precision, which applications store
QUARTER = np.array([[0, 1], [-1, 0]])  # rows times it: a quarter turn counter-clockwise


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


@dataclass(frozen=True, eq=False)
class Square:
    """Maps packed into a square, each scaled until a UV unit is a unit of length where its density is the median one.

    surfaces : (n,) connected parts; uvs : their maps, (#C, 2) each; densities : (n,) of these, medians by area
    """

    surfaces: Sequence[Surface]
    uvs: Sequence[Reals]
    densities: Sequence[float]
    arrangement: Arrangement

    @cached_property
    def _frames(self) -> list[Frame]:
        return [frame(part, uv, self.arrangement.rotation) for part, uv in zip(self.surfaces, self.uvs)]

    @cached_property
    def _scales(self):
        """The scale of each map; 0 for a map without area, such as one whose coefficients are 0, which shrinks to a
        point.
        """
        return [_scale(*each) for each in zip(self.surfaces, self._frames, self.densities)]

    @cached_property
    def _sizes(self):
        return [[s * (f.high - f.low).real, s * (f.high - f.low).imag] for s, f in zip(self._scales, self._frames)]

    @cached_property
    def _packed(self):
        return pack(self._sizes, self.arrangement.margin)

    @property
    def filling(self) -> float:
        """`Arrangement.per_length` with which the maps fill the UV square; infinite where none has an area."""
        side = self._packed[1]
        return 1 / side if side > 0 else math.inf

    @property
    def used(self) -> float:
        """Part of the square that the maps cover, where they do not lie over themselves."""
        side = self._packed[1]
        covered = sum(found.area * scale**2 for found, scale in zip(self._frames, self._scales))
        return covered / side**2 if side > 0 else 0.0

    def factor(self, part: int) -> complex:
        """The factor by which the map of a part is multiplied."""
        return self.per_length * self._scales[part] * cmath.exp(1j * self.arrangement.rotation)

    @property
    def per_length(self) -> float:
        """UV length for a length on the surface, where the density is the median one; 0 for maps without area."""
        wanted = self.arrangement
        return wanted.density * (wanted.per_length or self.filling) if self._packed[1] > 0 else 0.0

    def write(self, placed: Reals) -> None:
        """Writes the maps into (#C of the mesh as given, 2) UVs."""
        corners, side = self._packed
        middle, back = complex(side, side) / 2, cmath.exp(-1j * self.arrangement.rotation)
        for k, (part, uv, size) in enumerate(zip(self.surfaces, self.uvs, self._sizes)):
            origin = (self._frames[k].low + self._frames[k].high) / 2 * back
            target = CENTRE + self.per_length * (complex(*corners[k]) + complex(*size) / 2 - middle)
            place(uv, self.factor(k), origin, target, placed, None if part.is_whole else part.corner_index)


def square(maps: Sequence[Map], arrangement: Arrangement = Arrangement()) -> Square:
    """The `Square` of the maps of parts, of whichever kinds."""
    return Square([m.surface for m in maps], [m.uv for m in maps], [m.density for m in maps], arrangement)


def arranged(maps: Sequence[Map], corners: int, arrangement: Arrangement = Arrangement()) -> Reals:
    """(#C, 2) UVs of a mesh from the maps of its parts; zeros at corners without a map.

    Beside a tiling all values are exact in single precision.
    """
    uv = np.zeros((whole_number(corners, "corners", _corner_count(made.surface for made in maps)), 2))
    tiled, rest = [m for m in maps if m.is_tiled], [m for m in maps if not m.is_tiled]
    if not tiled:
        square(rest, arrangement).write(uv)
        return uv
    _write_tilings(tiled, uv, arrangement.quarters)
    uv = on_grid(uv)
    if rest:
        _write_beside(rest, uv, _unit_of_tilings(tiled), arrangement)
    return uv


def arranged_form(
    parts: Sequence[tuple[Surface, AnyStructure]], form: int, corners: int, arrangement: Arrangement = Arrangement()
) -> Reals:
    """(#C, 2) UVs of a mesh: the maps of one form, counted from 0, of parts with their structures; zeros at corners of
    parts that lack it."""
    form, surfaces, uvs, densities = whole_number(form, "form"), [], [], []
    for surface, structure in parts:
        if form < structure.form_count:  # their type of coefficients: a complex factor would bend straight boundaries
            surfaces.append(surface)
            uvs.append(structure.uv(np.eye(structure.form_count, dtype=structure.coefficient_type)[form]))
            densities.append(structure.quality(uvs[-1]).median_density)
    uv = np.zeros((whole_number(corners, "corners", _corner_count(surface for surface, _ in parts)), 2))
    Square(surfaces, uvs, densities, arrangement).write(uv)
    return uv


def _corner_count(surfaces):
    """The corners up to the last one of any of the parts."""
    return max((int(surface.corner_index.max()) + 1 for surface in surfaces), default=0)


def unit_length(maps: Sequence[Map], arrangement: Arrangement = Arrangement()) -> float:
    """The length on the surface of a UV unit of `arranged` maps, where the density is the median one; 0 for maps
    without area."""
    tiled = [m for m in maps if m.is_tiled]
    if tiled:
        return _unit_of_tilings(tiled)
    wanted = square(maps, arrangement).per_length
    return 1 / wanted if wanted > 0 else 0.0


def common_length(objects: Sequence[Sequence[Map]], arrangement: Arrangement = Arrangement()) -> float:
    """`Arrangement.per_length` with which the maps of several objects have one size: that of tilings, or the largest
    with which each object fits into the UV square; 0 where none has area."""
    tiled = [m for maps in objects for m in maps if m.is_tiled]
    if tiled:
        unit = _unit_of_tilings(tiled)
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
    """Rounds to multiples of a power of two that single precision holds, so that differences by whole numbers stay
    exact."""
    step = 2.0 ** (math.frexp(max(np.abs(uv).max(), 1.0))[1] - SINGLE_BITS)
    return np.rint(np.asarray(uv) / step) * step  # ties to even ones: the same on both sides of a turn


def _scale(surface, found, density):
    """Less where a map is `SCATTERED`, as by triangles without area between its others."""
    if density > 0:
        size = max((found.high - found.low).real, (found.high - found.low).imag)
        return min(density**-0.5, SCATTERED * math.sqrt(surface.area) / size if size > 0 else math.inf)
    return math.sqrt(surface.area / found.area) if found.area > 0 else 0.0


def _unit_of_tilings(tiled):
    density = np.median([m.density for m in tiled])
    return 1 / math.sqrt(density) if density > 0 else 0.0


def _write_tilings(tiled, uv, quarters):
    """Writes tilings side by side, on shelves of whole units; shifts by whole hexagons alone keep sixth turns."""
    turn = np.linalg.matrix_power(QUARTER, quarters % 4)
    turned = [m.uv @ turn for m in tiled]
    steps = [np.array([1.0, math.sqrt(3) if m.turns == 6 else 1.0]) for m in tiled]
    lows = [np.floor(values.min(axis=0) / step) * step for values, step in zip(turned, steps)]
    sizes = np.array([np.ceil(v.max(axis=0) - low + step - 1) for v, low, step in zip(turned, lows, steps)])
    width = max(math.ceil(math.sqrt(np.prod(sizes, axis=1).sum())), sizes[:, 0].max())
    corners, _ = rows(sizes, width, 0.0)
    for made, values, low, corner, step in zip(tiled, turned, lows, corners, steps):
        uv[made.surface.corner_index] = values + (np.ceil(corner / step) * step - low)


def _write_beside(rest, uv, unit, arrangement):
    """Writes other maps to the right of tilings, at their texel density, in a square that stands on v = 0."""
    scaled = replace(arrangement, density=1.0, per_length=1 / unit if unit > 0 else 0.0)
    values, laid = np.zeros_like(uv), square(rest, scaled)
    laid.write(values)
    side = laid.per_length / laid.filling
    low, right = CENTRE.real - side / 2, math.ceil(uv[:, 0].max())
    corners = np.concatenate([m.surface.corner_index for m in rest])
    shift = np.float32([right + arrangement.margin * side - low, -low])
    uv[corners] = values[corners].astype(np.float32) + shift
