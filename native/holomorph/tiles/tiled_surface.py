"""A surface under a tiling, and what lies in its tiles."""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.value import Value, counted, quoted
from ..mesh.checks import check_options, check_type, checked_uv
from ..mesh.surface import Surface
from ..tiling.request import MOST_PER_TILE, checked_turns, generators
from .places import Cells, Lines, Places
from .relief import Relief, raised
from .turned_surface import Curves, check_grid, directions, joined, opened


class TiledSurface(Value):
    """A surface with UVs that jump by whole tiles only, also those of a file: `Map.tiled` of a map that is a tiling.

    What is looked for in the tiles is decided exactly, so that everything is found once, on both sides of every seam.

    Parameters
    ----------
    surface : Surface with positions
    uv : (#C, 2) UVs at the polygon corners, also in single precision; vertices at which they do not close up by whole
        tiles are the poles
    lattice : of the texture, as in `Structure.tile`: a tile is the parallelogram of its two translations, by default
        the unit square
    threads : number of threads; None for all processors. No result depends on it
    turns : 2, 4 or 6 where the UVs may also turn, see `Tiling.turns`: there are places and lines that the turn leaves

    Raises TopologyError for a surface without positions, and for UVs that are not a tiling: where they jump by parts of
    a tile, or differently at the two ends of an edge, or two poles are neighbours or one lies on the boundary;
    ValueError.
    """

    def __init__(
        self,
        surface: Surface,
        uv: ArrayLike,
        lattice: str | ArrayLike = "square",
        threads: int | None = None,
        *,
        turns: int = 1,
    ) -> None:
        check_type(surface, Surface)
        if surface.vertices is None:
            raise TopologyError("tiles need a surface with positions; this one has edge lengths only")
        self._threads = check_options("auto", threads)
        given = checked_uv(uv, surface)
        self.surface: Surface = surface
        self.uv: Reals = arrays.frozen(given.copy()) if given.flags.writeable else given
        a, b = generators(lattice)
        self.lattice: Reals = arrays.frozen(np.array([[a.real, b.real], [a.imag, b.imag]]))
        self.turns: int = checked_turns(turns)
        poles = self._coordinates().poles()
        self.poles: Integers = arrays.frozen(self._opened.vertices[poles]) if self._opened else poles

    _unpickled = ("_opened",)

    @cached_property
    def _opened(self):
        return None if self.turns == 1 else opened(self.surface, self.uv, self.turns, self.lattice)

    @property
    def _native(self):
        return self._opened.native if self._opened else self.surface._native

    def _facts(self):
        return [repr(self.surface), counted(len(self.poles), "pole")]

    @cached_property
    def pole_distances(self) -> Reals:
        """(#V,) length of the shortest way along edges to a pole; infinite where there is none."""
        native = self.surface._native
        return arrays.frozen(native.edge_distances(native.edge_lengths, self.poles.tolist()))

    def places(
        self,
        per_tile: tuple[int, int] = (1, 1),
        offset: tuple[float, float] = (0.5, 0.5),
        shifted_rows: bool = False,
        progress: Progress | None = None,
    ) -> Places:
        """The points of the surface at regular places in the tiles, each once: see `Places`.

        per_tile : columns and rows of places in a tile
        offset : of a place in its column and row, from 0 to 1: (0.5, 0.5) for the middles of the tiles, (0, 0) for
            their corners, (0.5, 0) and (0, 0.5) for the middles of their sides
        shifted_rows : every other row is moved by half a column, as bricks are; their number in a tile must be even
        progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

        Raises ValueError for others; SolverError for more than memory is meant for, a gigabyte or 100 kB a vertex;
        Cancelled. Cost: linear in triangles and places.
        """
        columns, rows = _grid(per_tile, shifted_rows)
        offset = arrays.numbers(_pair(offset, "offset"), "offset")
        if not np.isfinite(offset).all():
            raise ValueError(f"offset is {tuple(offset)}; two finite numbers are needed")
        check_grid(self.turns, (columns, rows), offset, shifted_rows)
        shift = rows // 2 if shifted_rows else 0
        coordinates = self._coordinates(((columns, -shift), (0, rows)), offset / (columns, rows))
        found = _native.places(self._native, coordinates, threads=self._threads, progress=progress)
        at, numbers = (found.triangles, found.barycentric), found.numbers
        if self._opened:
            kept = self._opened.first_ones(*at)
            *at, numbers = (arrays.frozen(each[kept]) for each in (*at, numbers))
        row = (numbers[:, 1] + offset[1]) / rows
        column = (numbers[:, 0] + offset[0] + (numbers[:, 1] / 2 if shifted_rows else 0)) / columns
        inside = np.stack([column, row], axis=1)
        tiles, uv = np.floor(inside).astype(np.int64), inside @ self.lattice.T
        return Places(*at, arrays.frozen(tiles), arrays.frozen(uv), found.flipped, self, numbers)

    def lines(self, direction: str | Sequence[int] = "u", per_tile: int = 1, progress: Progress | None = None) -> Lines:
        """The lines between the tiles in one direction, as curves on the surface: see `Lines`.

        direction : "u" for lines along the first vector of the lattice, "v" along the second, or two whole numbers
            without a common divisor: how many of each
        per_tile : as many lines for each tile, the first between tiles

        Where the tiling turns by quarters these are also the lines across, and by sixths those in three directions.

        progress : as of `places`, in each of these directions

        Raises ValueError for others; SolverError for too many points; Cancelled. Cost: linear in triangles and points.
        """
        a, b = _direction(direction)
        count = _count(per_tile, "per_tile")
        found = [self._lines((count * b, -count * a), progress) for a, b in directions((a, b), self.turns)]
        made = joined(self._opened, found) if self._opened else found[0]
        return Lines(*map(arrays.frozen, made), tiled=self)

    def _lines(self, step, progress):
        coordinates = self._coordinates((step, (0, 0)))
        found = _native.lines(self._native, coordinates, threads=self._threads, progress=progress)
        return Curves(found.offsets, found.is_closed.astype(bool), found.triangles, found.barycentric)

    def cells(
        self, per_tile: tuple[int, int] = (1, 1), shifted_rows: bool = False, progress: Progress | None = None
    ) -> Cells:
        """The surface with one polygon for each tile: see `Cells`.

        per_tile, shifted_rows, progress : as of `places`, which are the middles: with shifted rows cells are bricks

        Where the tiling turns by quarters, a tile has as many columns as rows, not shifted; where it turns by halves,
        bricks lie a quarter of their length to the left, as half turns leave them.

        Raises ValueError for others; TopologyError for a tiling that turns by sixths; SolverError for too many;
        Cancelled. Cost: linear in triangles and their pieces.
        """
        columns, rows = _grid(per_tile, shifted_rows)
        parts = 2 if shifted_rows else 1  # of the columns: rows of bricks begin with the first or the second
        lies = (-0.5 / parts if shifted_rows and self.turns == 2 else 0.0) / columns, 0.0
        self._check_cells((columns, rows), shifted_rows)
        coordinates = self._coordinates(((parts * columns, 0), (0, rows)), lies, turns=self.turns)
        options = {"bricks": shifted_rows, "threads": self._threads, "progress": progress}
        found = _native.cells(self.surface._native, coordinates, **options)
        points, first, is_whole = found.corner_points, found.offsets[:-1], found.is_whole.astype(bool)
        is_line = points == np.rint(points)
        if shifted_rows:
            is_line[:, 0] &= (points[:, 0] + np.repeat(found.tiles[:, 1], np.diff(found.offsets))) % 2 == 0
        is_corner = is_line.all(axis=1)
        is_tile = np.logical_and.reduceat(is_line.any(axis=1), first) & is_whole & (found.poles < 0)
        is_tile &= found.turns == 0
        made = {"is_corner": is_corner, "is_whole": is_whole, "_is_needed": found.is_needed.astype(bool)}
        made["is_quad"] = is_tile & (np.add.reduceat(is_corner.astype(int), first) == 4)
        made["tiles"] = (found.tiles + (0 if any(lies) else parts // 2, 0)) // (parts * columns, rows)
        made["uv"] = (points / (parts * columns, rows) + lies) @ self.lattice.T
        made = {name: arrays.frozen(values) for name, values in made.items()}
        same = {name: getattr(found, name) for name in ("corner_vertices", "poles", "triangles", "barycentric")}
        return Cells(**made, **same, face_offsets=found.offsets, tiled=self)

    def relief(
        self,
        heights: ArrayLike,
        depth: float,
        *,
        repeats: int = 1,
        level: float = 0.0,
        tolerance: float = 0.02,
        most_triangles: int = 1_000_000,
        pole_fade: float = 0.25,
        progress: Progress | None = None,
    ) -> Relief:
        """The surface raised along its normals by a picture in every tile, refined where that asks for it: see
        `Relief`. As tiles are whole, it closes up everywhere.

        heights : (rows, columns) from 0 to 1, the top row first, bilinear between the middles of pixels: over a tile,
            which is a parallelogram where the lattice is not square
        repeats : how often the picture lies in a tile, along each of its sides
        depth : by which a height of 1 is raised, in the unit of the positions, on the side from which triangles are
            counter-clockwise
        level : the height that stays on the surface: 0 raises all, 1 engraves all
        tolerance : of heights; triangles are halved until they are off by less, or their sides are below a pixel
        most_triangles : where that takes more, those that are farthest off are halved first
        pole_fade : in tiles: around a pole, whose triangles stay as they are, heights rise to their own over so much

        Where the tiling turns, the picture is to look the same after these turns: of what differs the mean is taken.

        Raises ValueError for others, a picture with the same height everywhere, one that does not look the same after
        turns of the tiling, or a depth above the size of the mesh; TopologyError for a tiling that turns by sixths;
        Cancelled. Cost: n log n in the triangles that are made.
        """
        self._refuse_sixths("a relief")
        return raised(self, heights, depth, repeats, level, tolerance, most_triangles, pole_fade, progress)

    def _check_cells(self, per_tile, shifted_rows):
        self._refuse_sixths("cells")
        if self.turns == 4 and (per_tile[0] != per_tile[1] or shifted_rows):
            raise ValueError("cells of a tiling with quarter turns have as many columns as rows, not shifted")

    def _refuse_sixths(self, thing):
        if self.turns == 6:
            raise TopologyError(f"{thing} cannot be made where tiles turn by sixths, which leave none: take turns=2")

    def _coordinates(self, steps=((1, 0), (0, 1)), origin=(0.0, 0.0), turns=1):
        """Those of the opened surface, but of the surface itself where turns are taken into account."""
        opened = self._opened if turns == 1 else None
        return _native.tile_coordinates(
            opened.native if opened else self.surface._native,
            opened.uv if opened else self.uv,
            inverse_lattice=np.linalg.inv(self.lattice),
            origin=np.asarray(origin, float),
            steps=np.asarray(steps, np.int32),
            turns=turns,
            threads=self._threads,
        )


def _pair(values, name):
    if np.shape(values) != (2,):
        raise ValueError(f"{name} is {quoted(values)}; two numbers are needed")
    return values


def _grid(per_tile, shifted_rows):
    columns, rows = (_count(number, "per_tile") for number in _pair(per_tile, "per_tile"))
    if shifted_rows and rows % 2:
        raise ValueError(f"shifted rows need an even number of rows per tile; per_tile is {per_tile}")
    return columns, rows


def _direction(direction):
    given = {"u": (1, 0), "v": (0, 1)}.get(direction, direction) if isinstance(direction, str) else direction
    if not isinstance(given, str) and np.shape(given) == (2,):
        a, b = given
        whole = all(isinstance(number, (int, np.integer)) and abs(number) <= MOST_PER_TILE for number in given)
        if whole and math.gcd(a, b) == 1:
            return int(a), int(b)
    raise ValueError(
        f'direction is {quoted(direction)}; "u", "v", or two whole numbers without a common divisor, up to '
        f"{MOST_PER_TILE}, are needed"
    )


def _count(value, name):
    try:
        count = operator.index(value)
    except TypeError:
        count = 0
    if not 1 <= count <= MOST_PER_TILE:
        raise ValueError(f"{name} has {quoted(value)}; whole numbers from 1 to {MOST_PER_TILE} are needed")
    return count
