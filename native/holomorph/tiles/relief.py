"""A surface raised by a picture of heights that repeats in its tiles, to be printed, and the vectors that move it."""

from __future__ import annotations

import numbers
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Reals
from ..core.value import Value, counted, quoted
from ..mesh.checks import check_options, real_number
from ..mesh.hard_edges import is_hard
from ..mesh.surface import Surface
from ..quality.verdicts import TURNED
from ..tiling.images import ALIKE
from ..tiling.request import MOST_PER_TILE

if TYPE_CHECKING:
    from .tiled_surface import TiledSurface

PARTS = 64  # of the depth, among which a safe one is found
LEAST_PART = 1 / PARTS
MOST_TRIANGLES = 2**30
LONGEST = 2.0  # of the vectors by which vertices are moved, for a height of 1: at sharper corners they are shorter
SHARP = 29.0  # degrees, from which on an edge breaks the surface: those of a prism with twelve sides do
REFLEX = 1.1 * np.pi
PULL = 1e-6  # towards the mean normal, against 1 for all faces: decides where these leave a direction free


@dataclass(frozen=True, eq=False, repr=False)
class Relief(Value):
    """Result of `TiledSurface.relief`: triangles, as closed and as connected as the surface. All arrays are read-only.

    base : (#V, 3) positions on the surface, its own vertices first
    heights : (#V,) of the picture, less the level, times the share that is left near poles
    triangles : (#T, 3) vertices, oriented as those of the surface
    uv : (#C, 2) of their corners, #C = 3 #T
    faces : (#T,) polygon in which each lies, of the mesh as given
    depth : by which a height of 1 moves a vertex
    error : of the heights, in the middle of triangles, where it was measured; times the depth it is a length
    is_full : there are as many triangles as were allowed, and the error is larger than the tolerance
    """

    base: Reals
    heights: Reals
    triangles: Integers
    uv: Reals
    faces: Integers
    depth: float
    error: float
    is_full: bool
    _offsets: Reals
    _threads: int

    def _facts(self):
        return [counted(len(self.triangles), "triangle"), f"{self.depth:.3g} deep"]

    @cached_property
    def vertices(self) -> Reals:
        """(#V, 3) positions."""
        return arrays.frozen(self.base + self.depth * self._offsets)

    @property
    def corner_vertices(self) -> Integers:
        """(#C,) vertices of the triangles, as in `Surface`."""
        return self.triangles.reshape(-1)

    @cached_property
    def face_offsets(self) -> Integers:
        """(#T + 1,) first corner of each triangle, as in `Surface`."""
        return arrays.frozen(np.arange(0, self.triangles.size + 1, 3, dtype=np.int32))

    @cached_property
    def volume(self) -> float:
        """The enclosed volume, in the cube of the positions' unit; of an open surface, that of the cone over it from
        the origin.
        """
        return volume(self.vertices, self.triangles)

    @cached_property
    def crossings(self) -> Integers:
        """(n, 2) pairs of triangles that go through each other, by more than rounding: none where the depth is below
        the distance to the middle between two sides of the surface, and below the radius of its hollows."""
        return _native.crossings(self.vertices, self.triangles, threads=self._threads)

    @cached_property
    def safe_depth(self) -> float:
        """The largest depth, in 64ths of `depth`, at which no triangles cross; 0 where they do at `LEAST_PART` of it,
        as where the surface itself does."""
        steps, pairs = PARTS, self.crossings
        while len(pairs) and steps:
            steps = self._safe_steps(self.triangles[np.unique(pairs)], steps)
            pairs = self._crossings(steps, self.triangles)
        return self.depth * steps / PARTS

    def _safe_steps(self, triangles, most):
        """The largest number of parts of the depth, below `most`, at which these triangles alone do not cross."""
        low, high = 0, most
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if len(self._crossings(middle, triangles)) else (middle, high)
        return low

    def _crossings(self, steps, triangles):
        moved = self.base + self.depth * steps / PARTS * self._offsets
        return _native.crossings(moved, triangles, threads=self._threads)

    def at_depth(self, depth: float) -> Relief:
        """The same triangles, raised by another depth. Raises ValueError for one that is not positive."""
        return replace(self, depth=real_number(depth, "depth", positive=True))


def joined(reliefs: Sequence[Relief]) -> Relief:
    """Joins several reliefs of one depth to one; those of `plain` may be among them."""
    first = np.cumsum([0, *(len(one.base) for one in reliefs)], dtype=np.int32)
    names = "base", "heights", "uv", "faces", "_offsets"
    whole = {name: np.concatenate([getattr(one, name) for one in reliefs]) for name in names}
    whole["triangles"] = np.concatenate([one.triangles + at for one, at in zip(reliefs, first)]).astype(np.int32)
    depth, error = (max(getattr(one, name) for one in reliefs) for name in ("depth", "error"))
    known = {"depth": depth, "error": error, "is_full": any(one.is_full for one in reliefs)}
    return replace(reliefs[0], **{name: arrays.frozen(array) for name, array in whole.items()}, **known)


def plain(surface: Surface) -> Relief:
    """The `Relief` of a surface without heights, which stays as it is."""
    shapes = {"heights": len(surface.vertices), "uv": (surface.triangles.size, 2), "_offsets": surface.vertices.shape}
    zeros = {name: arrays.frozen(np.zeros(shape)) for name, shape in shapes.items()}
    faces = surface.face_index[surface.triangle_faces]
    lies = {"base": surface.vertices, "triangles": surface.triangles, "faces": arrays.frozen(faces)}
    return Relief(**lies, **zeros, depth=0.0, error=0.0, is_full=False, _threads=check_options("auto", None))


def raised(
    tiled: TiledSurface, heights, depth, repeats, level, tolerance, most_triangles, pole_fade, progress
) -> Relief:
    """See `TiledSurface.relief`."""
    surface = tiled.surface
    pixels = symmetric(checked_heights(heights), tiled.turns)
    depth = checked_depth(depth, surface.vertices)
    most = check_choices(repeats, level, tolerance, most_triangles)
    of_vertices, of_corners, are_reflex = normals(surface, level == 0)
    found = _native.relief(
        surface._native,
        tiled._coordinates(((repeats, 0), (0, repeats)), turns=tiled.turns),
        normals=of_vertices,
        corner_normals=of_corners,
        are_reflex=are_reflex,
        shares=_shares(tiled, real_number(pole_fade, "pole_fade", positive=True)),
        pixels=pixels,
        depth=depth,
        level=float(level),
        tolerance=float(tolerance),
        most_triangles=most,
        progress=progress,
    )
    tiles = found.tiles.reshape(-1, 2) / repeats
    uv, faces = tiles @ tiled.lattice.T, surface.face_index[surface.triangle_faces[found.parents]]
    same = {name: getattr(found, name) for name in ("heights", "triangles", "error", "is_full")}
    own = {"base": found.positions, "uv": arrays.frozen(uv), "faces": arrays.frozen(faces), "_offsets": found.offsets}
    return Relief(**own, **same, depth=depth, _threads=tiled._threads)


def check_choices(repeats, level, tolerance, most_triangles):
    """The limit on the triangles. @throws ValueError"""
    if not isinstance(repeats, numbers.Integral) or not 1 <= repeats <= MOST_PER_TILE:
        raise ValueError(f"repeats has {quoted(repeats)}; whole numbers from 1 to {MOST_PER_TILE} are needed")
    for value, name in ((level, "level"), (tolerance, "tolerance")):
        if not 0 <= real_number(value, name) <= 1:
            raise ValueError(f"{name} is {quoted(value)}; a height from 0 to 1 is needed")
    return int(min(real_number(most_triangles, "most_triangles", positive=True), MOST_TRIANGLES))


def stretched_sentence(columns, rows):
    """What is said of a picture that is not as high as it is wide, in pixels."""
    return (
        f"the picture has {columns} x {rows} pixels: each tile shows it stretched to a square, by {columns / rows:.3g}"
    )


def checked_heights(heights):
    """(h, w) float64, from 0 to 1 and not all alike. @throws ValueError"""
    pixels = arrays.numbers(heights, "heights")
    if pixels.ndim != 2 or not pixels.size:
        raise ValueError(f"heights has the shape {pixels.shape}; (rows, columns) are needed")
    low, high = pixels.min(), pixels.max()
    if not np.isfinite([low, high]).all():
        raise ValueError("heights must be finite numbers from 0 to 1")
    if low < 0 or high > 1:
        raise ValueError(f"heights must be from 0 to 1, not from {low:.3g} to {high:.3g}")
    if low == high:
        raise ValueError(f"the picture has the height {low:.3g} everywhere: nothing can be raised")
    return pixels


def symmetric(pixels: Reals, turns: int) -> Reals:
    """The mean of (h, w) heights over the turns about the middle. Raises ValueError where they look another way
    then."""
    if turns == 1:
        return pixels
    if turns == 4 and pixels.shape[0] != pixels.shape[1]:
        raise ValueError(f"{pixels.shape[1]} x {pixels.shape[0]} pixels cannot turn by a quarter: a square is needed")
    turned = [np.rot90(pixels, k * 4 // turns) for k in range(turns)]
    differences = [pixels - pixels.mean(), turned[1] - pixels.mean()]
    alike = (differences[0] * differences[1]).sum() / np.square(differences[0]).sum()
    if alike < ALIKE:
        raise ValueError(
            f"the heights do not look the same after {TURNED[turns]} about the middle of the picture, as the tiling "
            f"does ({100 * max(alike, 0):.0f} %): make the map without turns"
        )
    return sum(turned) / turns


def checked_depth(depth, vertices):
    """A positive float that is no larger than the mesh itself. @throws ValueError"""
    depth = real_number(depth, "depth", positive=True)
    size = float(np.linalg.norm(vertices.max(axis=0) - vertices.min(axis=0)))
    if depth >= size:
        raise ValueError(f"a depth of {depth:.6g} is more than the size of the whole mesh, {size:.6g}")
    return depth


def volume(vertices, triangles):
    """The signed volume inside closed triangles."""
    a, b, c = np.moveaxis(vertices[triangles] - vertices.mean(axis=0), 1, 0)
    return float(np.einsum("ni,ni->", a, np.cross(b, c)) / 6)


def _shares(tiled, width):
    """(#V,) part of its height that each vertex gets: 0 in the triangles at poles, from there rising smoothly over
    `width` tiles of the middle size."""
    surface, count = tiled.surface, len(tiled.surface.vertices)
    if not len(tiled.poles):
        return np.ones(count)
    is_pole = np.zeros(count, bool)
    is_pole[tiled.poles] = True
    at_poles = is_pole[surface.triangles].any(axis=1)
    native = surface._native
    star = np.unique(surface.triangles[at_poles])
    distance = native.edge_distances(native.edge_lengths, star.tolist())
    corners = tiled.uv[surface.triangle_corners[~at_poles]]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    tiles = np.abs(ax * by - ay * bx).sum() / 2 / abs(np.linalg.det(tiled.lattice))
    side = np.sqrt(surface.area / tiles) if tiles > 0 else np.inf
    part = np.clip(distance / (width * side), 0, 1)
    return part * part * (3 - 2 * part)


def normals(surface, is_raised=True):
    """((#V, 3), (3 #T, 3), (3 #T,) bool): vectors by which vertices are moved; the same of each corner of the triangles
    for the smooth part of the surface around it alone; whether that part has more than half of the angle.

    Moved by these, faces stay parallel to themselves. Hollow edges part nothing: their two sides come nearer to each
    other, over all of their faces. So do those of convex edges where the surface is not only raised.

    On a smooth part it is m / m^2, m the mean of the normals around by angles. Where sharp edges meet, it is the vector
    whose components along the normals of all parts are theirs, by least squares.
    """
    fans = _native.corner_fans(surface._native, is_hard(surface, SHARP) & _is_convex(surface))
    vertices, count = surface.triangles.ravel(), len(surface.vertices)
    corner, angle = corner_normals(surface)
    of_fans, weight = _mean(corner, angle, fans, len(fans))
    moved, _ = _mean(corner, angle, vertices, count)
    first = np.unique(fans)
    is_sharp = np.bincount(vertices[first], minlength=count) > 1
    first = first[is_sharp[vertices[first]]]
    if len(first):
        moved[is_sharp] = _all_parallel(of_fans[first], weight[first], vertices[first], moved)[is_sharp]
    return moved, of_fans[fans] if is_raised else moved[vertices], weight[fans] > REFLEX


def _is_convex(surface):
    """(#E,) whether the triangles of an edge lie below each other's planes."""
    triangles, points = surface.triangles, surface.vertices
    edges = surface._native.triangle_edges.ravel()
    order = np.argsort(edges, kind="stable")
    both = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, other = order[both], order[both + 1]
    a, b, c = (points[triangles[one // 3, k]] for k in range(3))
    beyond = points[triangles[other // 3, (other + 2) % 3]]  # opposite to the edge
    result = np.zeros(len(surface._native.edges), bool)
    result[edges[one]] = np.einsum("ij,ij->i", np.cross(b - a, c - a), beyond - a) < 0
    return result


def corner_normals(surface):
    """((#T, 3) unit normals of the triangles, 0 where they have no area; (#T, 3) their angles)."""
    corners = surface.vertices[surface.triangles]
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cross = np.cross(after, before)
    angle = np.arctan2(np.linalg.norm(cross, axis=2), np.einsum("tik,tik->ti", after, before))
    normal = cross[:, 0]
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.divide(normal, length, out=np.zeros_like(normal), where=length > 0), np.where(length > 0, angle, 0)


def _mean(normal, angle, labels, count):
    """((count, 3) m / m^2 of the triangles at each label, no longer than `LONGEST`; (count,) sums of their angles).

    labels : (3 #T,) of the corners
    """
    weighted = (angle[:, :, None] * normal[:, None]).reshape(-1, 3)
    total = np.bincount(labels, angle.ravel(), count)
    sums = np.stack([np.bincount(labels, weighted[:, k], count) for k in range(3)], axis=1)
    mean = np.divide(sums, total[:, None], out=np.zeros_like(sums), where=total[:, None] > 0)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    unit = np.divide(mean, size, out=np.zeros_like(mean), where=size > 0)
    return unit / np.maximum(size, 1 / LONGEST), total


def _all_parallel(of_parts, weight, vertices, mean):
    """(#V, 3) x with x . n = n . n for the vectors n of all parts at a vertex, by least squares with their weights."""
    count = len(mean)
    total = np.maximum(np.bincount(vertices, weight, count), np.finfo(float).tiny)
    weight = weight / total[vertices]
    size = np.maximum(np.linalg.norm(of_parts, axis=1, keepdims=True), np.finfo(float).tiny)
    unit = of_parts / size
    squares = weight[:, None, None] * unit[:, :, None] * unit[:, None]
    matrix = np.stack([np.bincount(vertices, each, count) for each in squares.reshape(-1, 9).T], axis=1)
    wanted = np.stack([np.bincount(vertices, each, count) for each in (weight[:, None] * of_parts).T], axis=1)
    found = np.linalg.solve(matrix.reshape(-1, 3, 3) + PULL * np.eye(3), (wanted + PULL * mean)[:, :, None])[:, :, 0]
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return found * np.minimum(1, LONGEST / np.maximum(length, np.finfo(float).tiny))
