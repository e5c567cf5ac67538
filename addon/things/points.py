# SPDX-License-Identifier: GPL-3.0-or-later
"""The places of pieces on a surface, as arrays. No bpy here: it runs in a worker thread."""

import math
from dataclasses import dataclass

import numpy as np

from . import parts, placing
from .pieces import Cell

FAR = 1e30  # distance of poles where there are none: Blender's numbers are single precision
OFFSETS = {"CENTRES": (0.5, 0.5), "CORNERS": (0.0, 0.0), "LOWER_EDGES": (0.5, 0.0), "LEFT_EDGES": (0.0, 0.5)}


@dataclass(frozen=True)
class Arrangement:
    """Where the places are."""

    columns: int  # in a tile
    rows: int
    is_shifted: bool  # every other row by half a cell
    place: str = "CENTRES"  # of `OFFSETS`
    turns: int = 1  # of the map

    @property
    def offset(self):
        """Where a place is in its column and row. A half turn leaves shifted rows as they are, as it does bricks."""
        x, y = OFFSETS[self.place]
        return ((x - y / 2) % 1, y) if self.turns == 2 and self.is_shifted else (x, y)

    def cell(self, lattice):
        """The `pieces.Cell` of each place, for the (2, 2) lattice of a tiling whose first translation lies along u."""
        width = lattice[0, 0] / self.columns
        along, up = lattice[:, 1] / self.rows
        return Cell(up / width, (along / width + self.is_shifted / 2) % 1)


LEFT_BY_TURNS = {
    4: "a map with quarter turns has as many rows as columns, with places at centres or corners",
    6: "a map with sixth turns has as many rows as columns, with places at corners",
}


def is_left_by_turns(turns, columns, rows, place):
    """Whether places can lie so on a map that turns."""
    if turns <= 2:
        return True
    return rows in (0, columns) and place in ("CENTRES", "CORNERS")[turns == 6 :]


def arrangement(height, is_shifted, columns, rows, place, turns, lattice):
    """The `Arrangement` in tiles of this (2, 2) lattice; rows 0 makes cells as high as a piece wants it, in widths, but
    on a map that turns by less than a half."""
    if turns > 2:
        return Arrangement(columns, columns, False, place, turns)
    asked = rows or max(1, round(columns * lattice[1, 1] / (lattice[0, 0] * height)))
    is_shifted = is_shifted and not _is_shifted_already(columns, asked, lattice)
    if is_shifted and not rows:
        asked = 2 * max(1, round(asked / 2))
    return Arrangement(columns, asked, is_shifted and asked % 2 == 0, place, turns)


def _is_shifted_already(columns, rows, lattice):
    """Whether the lattice itself has every other row shifted by half a cell."""
    return math.isclose(lattice[0, 1] / rows * columns / lattice[0, 0] % 1, 0.5, abs_tol=1e-6)


def found(tiled, progress, arranged):
    """(attributes of the places on a `holomorph.TiledSurface`, (n,) or (n, 3), by name; its lattice). `arranged` gives
    the `Arrangement` for a lattice."""
    arranged = arranged(tiled.lattice)
    places = tiled.places((arranged.columns, arranged.rows), arranged.offset, arranged.is_shifted, progress)
    width = tiled.lattice[0, 0] / arranged.columns
    inside = places.uv @ np.linalg.inv(tiled.lattice).T
    row = np.rint(inside[:, 1] * arranged.rows - arranged.offset[1]).astype(np.int64)
    column = np.floor(inside[:, 0] * arranged.columns).astype(np.int64)
    steps = _steps(places, width)
    size = width * places.sizes
    values = parts.surface_values(places) | {
        placing.ROW_STEP: steps[:, :, 0],
        placing.COLUMN_STEP: steps[:, :, 1],
        placing.RELATIVE_SIZE: size,
        placing.POLE_DISTANCE: np.minimum(places.pole_distances / size, FAR),
        placing.LEANING: 1.0 - 2.0 * (row % 2),
        placing.PIECE_INDEX: column + row,
        "tile_u": places.tiles[:, 0],
        "tile_v": places.tiles[:, 1],
        "sheet": places.sheets,
    }
    return values, tiled.lattice


def joined(found_on_parts):
    """What `found` gives, of all parts; sizes are related to the middle one."""
    dictionaries, lattices = zip(*found_on_parts)
    values = parts.joined(dictionaries)
    if len(values[placing.RELATIVE_SIZE]):
        values[placing.RELATIVE_SIZE] = values[placing.RELATIVE_SIZE] / np.median(values[placing.RELATIVE_SIZE])
    return values, lattices[0]


def _steps(places, width):
    """(n, 3, 2) a cell's width along u, and the same along v, in the two edges from the first vertex of each triangle;
    the third number is 0."""
    tiled = places.tiled
    uv = tiled.uv[tiled.surface.triangle_corners[places.triangles]]
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    inverse = np.array([[b[:, 1], -b[:, 0]], [-a[:, 1], a[:, 0]]]) / (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    steps = np.zeros((len(places), 3, 2))
    steps[:, :2] = width * np.moveaxis(inverse, 2, 0)
    return steps
