"""Regular places in the tiles of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..core import arrays
from ..core.array_types import Integers, Reals
from ..core.value import counted
from .surface_points import SurfacePoints

if TYPE_CHECKING:
    from .tiled_surface import TiledSurface


@dataclass(frozen=True, eq=False, repr=False)
class Places(SurfacePoints):
    """Result of `TiledSurface.places`: n points of the surface, each once, also on edges and where the map branches, in
    the order of the triangles. All arrays are read-only; what is not listed here is computed when asked for.

    A place on an edge, or at a vertex, lies in one triangle there. Those on the boundary belong to the surface. The
    triangles at a pole each have UVs of their own; at the pole itself there is no place.

    triangles : (n,) of `surface.triangles`, ascending
    barycentric : (n, 3) coordinates there
    tiles : (n, 2) integers: the tile that each lies in, in vectors of the lattice; beyond a seam they go on elsewhere
    uv : (n, 2) of the places
    flipped : how many more there are in flipped triangles, which are left out. Without boundary and poles `n - flipped`
        is the signed area in tiles, times the places in each, less the order of each branch that hits a place
    tiled : the `TiledSurface`
    """

    triangles: Integers
    barycentric: Reals
    tiles: Integers
    uv: Reals
    flipped: int
    tiled: TiledSurface
    _numbers: Integers

    def __len__(self) -> int:
        return len(self.triangles)

    def _facts(self):
        return [counted(len(self), "place"), f"{self.flipped} more in flipped triangles"]

    @cached_property
    def tangents(self) -> Reals:
        """(n, 2, 3) derivatives of the position by u and by v, in the triangle."""
        surface = self.tiled.surface
        corners = surface.vertices[self._corners]
        uv = self.tiled.uv[surface.triangle_corners[self.triangles]]
        along, (a, b) = corners[:, 1:] - corners[:, :1], np.moveaxis(uv[:, 1:] - uv[:, :1], 1, 0)
        inverse = np.stack([b[:, 1], -a[:, 1], -b[:, 0], a[:, 0]], axis=1).reshape(-1, 2, 2)
        return arrays.frozen(inverse @ along / (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[:, None, None])

    @cached_property
    def normals(self) -> Reals:
        """(n, 3) unit normals of the triangles, on the side from which they are counter-clockwise."""
        a, b, c = np.moveaxis(self.tiled.surface.vertices[self._corners], 1, 0)
        return arrays.frozen(_unit(np.cross(b - a, c - a)))

    @cached_property
    def sizes(self) -> Reals:
        """(n,) length on the surface of a UV unit: the root of the area of a unit square."""
        du, dv = np.moveaxis(self.tangents, 1, 0)
        return arrays.frozen(np.sqrt(np.linalg.norm(np.cross(du, dv), axis=1)))

    @cached_property
    def sheets(self) -> Integers:
        """(n,) which of the places with the same UVs it is, from 0 on, in their order: tiles on different sheets of the
        map have the same integers."""
        order = np.lexsort(self._numbers.T)
        ordered = self._numbers[order]
        is_first = np.ones(len(self), bool)
        is_first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
        begin = np.maximum.accumulate(np.where(is_first, np.arange(len(self)), 0))
        sheets = np.empty(len(self), np.int64)
        sheets[order] = np.arange(len(self)) - begin
        return arrays.frozen(sheets)

    @cached_property
    def pole_distances(self) -> Reals:
        """(n,) length of the shortest way to a pole over the surface that goes straight to a corner of the triangle and
        then along edges; infinite where there is no pole."""
        from_corner = np.linalg.norm(self.tiled.surface.vertices[self._corners] - self.positions[:, None], axis=2)
        return arrays.frozen((from_corner + self.tiled.pole_distances[self._corners]).min(axis=1))


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
