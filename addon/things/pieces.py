# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces that suit a tiling, by formulas. No bpy here.

Lengths are in widths of a cell: the row of cells runs along x, cells are `Cell.height` high along y, and the surface is
z = 0. Each piece lies as it is to lie in its cell, at the place (0, 0).
"""

import math
from dataclasses import dataclass

import numpy as np

AROUND = 24  # corners of a round outline
RADIUS, WIRE = 0.42, 0.05  # of a ring, and of its wire: no ring of flat mail comes nearer than 0.14 to another
YARN = 0.1  # radius of the yarn of a stitch: it comes no nearer than 0.24 to that of other ones


@dataclass(frozen=True)
class Cell:
    """The cell of a place: its height, and the shift of the next row, both in its width."""

    height: float
    shift: float = 0.0


@dataclass(frozen=True)
class Piece:
    """A formula, and how its pieces stand."""

    formula: object  # of a `Cell`: ((n, 3) vertices, list of lists of vertices)
    height: float  # of the cell that suits it best
    is_shifted: bool  # whether every other row is moved by half a cell
    tilt: float = 0.0  # radians by which it leans
    is_alternating: bool = False  # whether every other row leans to the other side
    above: float = 0.0  # the surface: its middle


def _swept(outline, profile, rise=0.0):
    """An outline, (k, 2) counter-clockwise about (0, 0), shrunk by the factors and lifted to the heights of the
    profile's (factor, height), from below to the top, which is one vertex. Closed below. `rise` lifts the lower end."""
    slope = rise * (outline[:, 1].max() - outline[:, 1]) / np.ptp(outline[:, 1])
    middle = rise * outline[:, 1].max() / np.ptp(outline[:, 1])
    factors, heights = np.array(profile[:-1]).T
    loops = np.empty((len(factors), len(outline), 3))
    loops[:, :, :2] = factors[:, None, None] * outline
    loops[:, :, 2] = heights[:, None] + middle + factors[:, None] * (slope - middle)
    top = [[0.0, 0.0, profile[-1][1] + middle]]
    last = np.arange(len(outline)) + loops[..., 0].size - len(outline)
    fan = np.stack([last, np.roll(last, -1), np.full(len(last), loops[..., 0].size)], axis=1)
    faces = [*_quads(*loops.shape[:2], False, True), *fan.tolist(), list(range(len(outline)))[::-1]]
    return np.concatenate([loops.reshape(-1, 3), top]), faces


def _quads(rows, columns, is_closed_along, is_closed_across):
    """The faces of a grid of vertices, row by row; which way round depends on the grid."""
    i, j = np.meshgrid(
        np.arange(rows - (not is_closed_along)), np.arange(columns - (not is_closed_across)), indexing="ij"
    )
    i2, j2 = (i + 1) % rows, (j + 1) % columns
    corners = [i * columns + j, i * columns + j2, i2 * columns + j2, i2 * columns + j]
    return np.stack(corners, axis=-1).reshape(-1, 4).tolist()


def _tube(curve, radius, is_closed, sides=8):
    """A tube about (n, 3) points, round across."""
    along = np.gradient(curve, axis=0, edge_order=2)
    if is_closed:
        along = np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, along)
    angle = 2 * np.pi * np.arange(sides) / sides
    around = np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * up[:, None]
    points = curve[:, None] + radius * around
    return points.reshape(-1, 3), [face[::-1] for face in _quads(len(curve), sides, is_closed, True)]


def _circle(count=AROUND):
    angle = 2 * np.pi * np.arange(count) / count
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _rectangle(left, right, low, high):
    return np.array([[left, low], [right, low], [right, high], [left, high]], float)


def _scale(cell):
    """Its tip lies over the row below, where two scales meet."""
    x, y = _circle().T
    length = np.where(y > 0, 0.95, 1.25) * cell.height
    outline = np.stack([0.56 * np.sign(x) * np.abs(x) ** 0.7, length * y], axis=1)
    return _swept(outline, ((0.9, -0.1), (1.0, -0.05), (0.97, 0.0), (0.75, 0.05), (0.4, 0.08), (0.0, 0.09)), rise=0.2)


def _shingle(cell):
    outline = _rectangle(-0.48, 0.48, -1.15 * cell.height, 0.95 * cell.height)
    return _swept(outline, ((1.0, -0.06), (1.0, -0.01), (0.97, 0.0), (0.0, 0.0)), rise=0.14)


def _brick(cell):
    gap = 0.03
    outline = _rectangle(gap - 0.5, 0.5 - gap, gap - cell.height / 2, cell.height / 2 - gap)
    return _swept(outline, ((1.0, -0.1), (1.0, 0.12), (0.94, 0.15), (0.0, 0.15)))


def _plate(cell):
    """All that is nearer to this place than to another one, where rows are shifted by half a cell a hexagon."""
    if not math.isclose(cell.shift % 1, 0.5, abs_tol=1e-6) or cell.height < 0.5:
        outline = _rectangle(-0.5, 0.5, -cell.height / 2, cell.height / 2)
    else:
        low = (cell.height**2 - 0.25) / (2 * cell.height)
        high = (cell.height**2 + 0.25) / (2 * cell.height)
        outline = np.array([[0, -high], [0.5, -low], [0.5, low], [0, high], [-0.5, low], [-0.5, -low]])
    return _swept(0.95 * outline, ((1.0, -0.1), (1.0, 0.05), (0.9, 0.09), (0.0, 0.09)))


def _stud(cell):
    corner = 0.32 * min(1.0, cell.height)
    outline = _rectangle(-corner, corner, -corner, corner)
    return _swept(outline, ((1.0, -0.1), (1.0, 0.06), (0.9, 0.1), (0.0, 0.3)))


def _rivet(cell):
    radius = 0.24 * min(1.0, cell.height)
    angles = np.linspace(0, np.pi / 2, 6)
    dome = [(math.cos(angle), 0.7 * radius * math.sin(angle)) for angle in angles]
    return _swept(radius * _circle(16), [(1.0, -0.1), *dome[:-1], (0.0, dome[-1][1])])


def _ring(cell):
    """Lies flat; tilted, it holds the two rings of each of the rows beside it: four in one."""
    return _tube(RADIUS * np.pad(_circle(32), ((0, 0), (0, 1))), WIRE, is_closed=True)


def stitch(cell, count=33):
    """(count, 3) points of the yarn in a plain stitch: it goes on in the cells beside, and its loop through that of the
    row below."""
    t = np.linspace(0, 2 * np.pi, count)
    x = t / (2 * np.pi) - 0.5 + 0.24 * np.sin(2 * t)
    return np.stack([x, -0.85 * cell.height * np.cos(t), -0.18 * np.cos(2 * t)], axis=1)


def _knit(cell):
    return _tube(stitch(cell), YARN, is_closed=False)


PIECES = {
    "SCALE": Piece(_scale, 0.5, True),
    "SHINGLE": Piece(_shingle, 0.5, True),
    "BRICK": Piece(_brick, 0.5, True),
    "PLATE": Piece(_plate, math.sqrt(0.75), True),
    "STUD": Piece(_stud, 1.0, False),
    "RIVET": Piece(_rivet, 1.0, False),
    "RING": Piece(_ring, 0.4, True, tilt=math.radians(29), is_alternating=True, above=0.22),
    "STITCH": Piece(_knit, 0.75, False, above=0.2),
}
ANY = Piece(None, 1.0, False)  # of the user's own
