"""Points on the tiles of a surface: regular places, and lines; and its tiles as polygons."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from ..core import arrays
from ..core.array_types import Flags, Integers, Reals
from ..core.value import Value, counted

if TYPE_CHECKING:
    from .tiled_surface import TiledSurface


class SurfacePoints(Value):
    """Base of what lies on a `TiledSurface`, its points given by triangles and coordinates there."""

    triangles: Integers
    barycentric: Reals
    tiled: TiledSurface

    def of(self, values: ArrayLike) -> NDArray[Any]:
        """(n, ...) values at the points, of (#V, ...) values at the vertices of the surface, such as its positions in
        another pose."""
        return np.einsum("ni,ni...->n...", self.barycentric, np.asarray(values)[self._corners])

    @cached_property
    def positions(self) -> Reals:
        """(n, 3) positions in space."""
        return arrays.frozen(self.of(self.tiled.surface.vertices))

    @cached_property
    def _corners(self):
        """(n, 3) vertices."""
        return self.tiled.surface.triangles[self.triangles]


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


@dataclass(frozen=True, eq=False, repr=False)
class Lines(SurfacePoints):
    """Result of `TiledSurface.lines`: polylines on the surface, with a point on each edge that they cross. All arrays
    are read-only.

    offsets : (#L + 1,) line l has the points from ``offsets[l]`` to ``offsets[l + 1]``
    is_closed : (#L,) bool: the last point is joined to the first. Others end on the boundary, at the star of a pole, or
        at a vertex where the map branches or folds on a line
    triangles : (n,) of `surface.triangles`, in which each point lies, on an edge
    barycentric : (n, 3) coordinates there
    tiled : the `TiledSurface`
    """

    offsets: Integers
    is_closed: Flags
    triangles: Integers
    barycentric: Reals
    tiled: TiledSurface

    def __len__(self) -> int:
        return len(self.is_closed)

    def _facts(self):
        return [counted(len(self), "line"), f"{int(self.is_closed.sum())} closed"]


@dataclass(frozen=True, eq=False, repr=False)
class Cells(SurfacePoints):
    """Result of `TiledSurface.cells`: a mesh of polygons, each a tile of the surface, or a part of a grid in it. It has
    the surface's topology. All arrays are read-only.

    The polygons follow the lines between tiles over the surface, with a vertex on each edge that these cross. Four of a
    polygon's vertices are corners of the tile wherever there is no pole, branch or boundary; `simplified` leaves others
    out, but a brick keeps the corners of those above and below it. The star of a pole, its triangles, is one polygon. A
    tile that is not a disk with a simple outline is cut into a few: it may have a hole, or meet itself around a limb.

    Where the tiling turns, a cone at a corner of tiles has as many of them around it as its angle has right ones, 3 or
    5. Around a cone inside it a tile has 3 or 5 sides, or is folded; its UVs do not close up. Tiles of an even number
    of columns and rows have their corners at all cones, and are quads.

    corner_vertices, face_offsets : (#C,) and (#F + 1,) the polygons, as in `Surface`, oriented as its triangles
    uv : (#C, 2) of each corner, continued across seams in a polygon
    is_corner : (#C,) bool: a corner of a tile
    tiles : (#F, 2) integers: the tile, in vectors of the lattice, as the UVs are
    poles : (#F,) the pole of a star, or -1
    is_quad : (#F,) bool: a whole tile, with its four corners and sides
    is_whole : (#F,) bool: a tile as far as it lies on the surface, or a star; not one of several parts
    triangles, barycentric : (#V,) and (#V, 3) where the vertices lie on the surface that was cut
    tiled : the `TiledSurface`
    """

    corner_vertices: Integers
    face_offsets: Integers
    uv: Reals
    is_corner: Flags
    tiles: Integers
    poles: Integers
    is_quad: Flags
    is_whole: Flags
    triangles: Integers
    barycentric: Reals
    tiled: TiledSurface
    _is_needed: Flags

    def __len__(self) -> int:
        return len(self.tiles)

    def _facts(self):
        parts = int((~self.is_whole).sum())
        counts = counted(int(self.is_quad.sum()), "quad"), counted(int((self.poles >= 0).sum()), "pole")
        return [counted(len(self), "polygon"), *counts, counted(parts, "part")]

    @property
    def vertices(self) -> Reals:
        """(#V, 3) positions."""
        return self.positions

    def simplified(self) -> Cells:
        """Leaves out the vertices between two others on the sides of polygons: a tile of four corners becomes a quad.
        Keeps vertices by which sides with the same ends differ, and those of polygons that would have fewer than
        three."""
        kept = _native.needed_vertices(self.face_offsets, self.corner_vertices, self._is_needed).astype(bool)
        used = np.flatnonzero(kept)
        number = np.cumsum(kept) - 1
        is_kept = kept[self.corner_vertices]
        counts = np.concatenate([[0], np.cumsum(is_kept)])
        return replace(
            self,
            corner_vertices=arrays.frozen(number[self.corner_vertices[is_kept]].astype(np.int32)),
            face_offsets=arrays.frozen(counts[self.face_offsets].astype(np.int32)),
            uv=arrays.frozen(self.uv[is_kept]),
            is_corner=arrays.frozen(self.is_corner[is_kept]),
            triangles=arrays.frozen(self.triangles[used]),
            barycentric=arrays.frozen(self.barycentric[used]),
            _is_needed=arrays.frozen(np.ones(len(used), bool)),
        )
