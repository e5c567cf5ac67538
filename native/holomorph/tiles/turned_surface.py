"""Surfaces under tilings that turn: cut open where the UVs turn, they are under tilings that only jump by whole tiles.

What lies on both sides of the cut is then found twice, and is joined here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core.array_types import Flags, Integers, Reals
from ..mesh.surface import Surface

PART = 1e-3  # of a tile: less is the rounding of UVs in single precision
NEAR = 1e-4  # of the length of an edge: places on both sides of it that are nearer are one, up to single precision


class Curves(NamedTuple):
    """Polylines, as `Lines` has them."""

    offsets: Integers
    is_closed: Flags
    triangles: Integers
    barycentric: Reals


@dataclass(frozen=True, eq=False)
class Opened:
    """A surface, and the same cut open.

    native : of the core, with the same triangles as polygons
    uv : (3 #T, 2) at their corners
    vertices : (n,) of the surface, of which those of `native` are copies
    is_cut : (#E,) of the edges of the surface
    """

    surface: Surface
    native: _native.Surface
    uv: Reals
    vertices: Integers
    is_cut: Flags

    def on_cut(self, triangles: Integers, barycentric: Reals) -> tuple[Integers, Reals]:
        """(n,) a number for the edge of the cut, or the vertex on it, at which each point lies, -1 for others; (n,) its
        place on the edge, from the lower vertex on."""
        corners, rows = self.surface.triangles[triangles].astype(np.int64), np.arange(len(triangles))
        is_zero = barycentric == 0
        at_vertex = is_zero.sum(axis=1) == 2
        side = (np.argmax(is_zero, axis=1) + 1) % 3  # from this corner to the next, opposite to the first zero
        start, end = corners[rows, side], corners[rows, (side + 1) % 3]
        edges = self.surface._native.triangle_edges[triangles, side].astype(np.int64)
        share = barycentric[rows, np.where(start < end, (side + 1) % 3, side)]
        on_edge = (is_zero.sum(axis=1) == 1) & self.is_cut[edges]
        vertex = corners[rows, np.argmax(barycentric, axis=1)]
        on_vertex = at_vertex & self._has_cut[vertex]
        key = np.where(on_edge, edges, np.where(on_vertex, len(self.is_cut) + vertex, -1))
        return key, np.where(on_edge, share, 0.0)

    @cached_property
    def _has_cut(self):
        """(#V,) whether an edge of the cut ends at a vertex."""
        result = np.zeros(len(self.surface.vertices), bool)
        result[self.surface._native.edges[self.is_cut]] = True
        return result

    def first_ones(self, triangles: Integers, barycentric: Reals) -> Flags:
        """(n,) which points to keep so that each of the surface is there once."""
        key, share = self.on_cut(triangles, barycentric)
        order, same = _at_one_place(key, share)
        kept = np.ones(len(key), bool)
        kept[order[1:][same]] = False
        return kept


def _at_one_place(key, share):
    """(the points in the order of their places on the cut, whether each is where the one before it is)."""
    order = np.lexsort([share, key])
    return order, (key[order[1:]] == key[order[:-1]]) & (np.diff(share[order]) < NEAR) & (key[order[1:]] >= 0)


def opened(surface: Surface, uv: Reals, turns: int, lattice: Reals) -> Opened:
    """The `Opened` surface, cut where the UVs of a tiling turn. Raises TopologyError where they turn otherwise."""
    is_cut = _turning_edges(surface, uv, turns, lattice)
    is_cut |= _beside_lonely(surface, is_cut)
    vertices, triangles = _native.parted_vertices(surface._native, is_cut)
    offsets = np.arange(0, triangles.size + 1, 3, dtype=np.int32)
    native = _native.Surface.from_polygons(surface.vertices[vertices], triangles.ravel(), offsets)
    return Opened(surface, native, uv[surface.triangle_corners.ravel()], vertices, is_cut)


def _turning_edges(surface, uv, turns, lattice):
    """(#E,) bool: the edges whose UVs on one side are nearest to those on the other when they are turned."""
    edges = surface._native.triangle_edges.ravel()
    corners, triangles = surface.triangle_corners, surface.triangles
    along = (uv[np.roll(corners, -1, axis=1)] - uv[corners]) @ [1, 1j]
    along = np.where(triangles < np.roll(triangles, -1, axis=1), along, -along).ravel()  # from the lower vertex on
    order = np.argsort(edges, kind="stable")
    pairs = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, other = along[order[pairs]], along[order[pairs + 1]]
    turn = np.exp(2j * np.pi / turns * np.arange(turns))
    best = np.argmin(np.abs(one[:, None] - turn * other[:, None]), axis=1)
    _check_whole(surface, uv, order[pairs], order[pairs + 1], turn[best], lattice)
    result = np.zeros(len(surface._native.edges), bool)
    result[edges[order[pairs]]] = best != 0
    return result


def _beside_lonely(surface, is_cut):
    """(#E,) bool: a further edge at each edge of the cut that is alone, for only from two on there are two sides."""
    edges, count = np.asarray(surface._native.edges), len(surface.vertices)
    is_border = np.bincount(surface._native.triangle_edges.ravel(), minlength=len(edges)) == 1
    at_vertex = np.bincount(edges[is_cut | is_border].ravel(), minlength=count)
    lonely = is_cut & (at_vertex[edges] == 1).all(axis=1)
    wanted = np.zeros(count, bool)
    wanted[edges[lonely, 0]] = True
    ends = np.where(~is_cut[:, None] & wanted[edges], edges, -1).ravel()
    vertices, first = np.unique(ends, return_index=True)
    result = np.zeros(len(edges), bool)
    result[first[vertices >= 0] // 2] = True
    return result


def _check_whole(surface, uv, one, other, turn, lattice):
    """Raises TopologyError where the UVs do not jump by whole tiles across sides that are turned."""
    corners, triangles = surface.triangle_corners, surface.triangles
    is_up = (triangles < np.roll(triangles, -1, axis=1)).ravel()
    lower = np.where(is_up, corners.ravel(), np.roll(corners, -1, axis=1).ravel())  # the corner at the lower vertex
    shift = uv[lower[one]] @ [1, 1j] - turn * (uv[lower[other]] @ [1, 1j])
    jumps = np.linalg.solve(lattice, np.stack([shift.real, shift.imag]))
    wrong = (np.abs(jumps - np.rint(jumps)).max(axis=0) > PART) & (turn != 1)
    if wrong.any():
        a, b = surface._native.edges[surface._native.triangle_edges.ravel()[one[np.argmax(wrong)]]].tolist()
        raise TopologyError(f"the UVs jump by parts of a tile across the edge from vertex {a} to {b}, where they turn")


def joined(opened: Opened, pieces: list[Curves]) -> Curves:
    """Curves that end at the edges of the cut, joined to those that go on from there. At cones they end."""
    triangles = np.concatenate([one.triangles for one in pieces])
    barycentric = np.concatenate([one.barycentric for one in pieces])
    counts = np.concatenate([np.diff(one.offsets) for one in pieces])
    is_closed = np.concatenate([one.is_closed for one in pieces]).astype(bool)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    ends = np.stack([offsets[:-1], offsets[1:] - 1], axis=1).ravel()  # of piece p: 2 p and 2 p + 1
    partner = _partners(opened, triangles[ends], barycentric[ends], np.repeat(is_closed, 2))
    chains, are_rings = _chains(partner)
    points = [np.concatenate(_points(chain, is_ring, offsets)) for chain, is_ring in zip(chains, are_rings)]
    closed = [is_ring or is_closed[chain[0] // 2] for chain, is_ring in zip(chains, are_rings)]
    order = np.concatenate(points) if points else np.empty(0, np.int64)
    made = np.concatenate([[0], np.cumsum([len(one) for one in points])]).astype(np.int64)
    return Curves(made, np.array(closed, bool), triangles[order], barycentric[order])


def _partners(opened, triangles, barycentric, is_closed):
    """(2 #P,) the end of a curve with which each end is joined, or -1."""
    key, share = opened.on_cut(triangles, barycentric)
    key = np.where(is_closed | (key >= len(opened.is_cut)), -1, key)
    order, same = _at_one_place(key, share)
    same[1:] &= ~same[:-1]
    first = np.flatnonzero(same)
    result = np.full(len(key), -1)
    result[order[first]], result[order[first + 1]] = order[first + 1], order[first]
    return result


def _chains(partner):
    """([the ends at which the pieces of each chain begin], whether its last end is joined to the first)."""
    chains, are_rings, is_done = [], [], np.zeros(len(partner) // 2, bool)
    open_ends = np.flatnonzero(partner < 0)
    for start in [*open_ends.tolist(), *range(0, len(partner), 2)]:
        if is_done[start // 2]:
            continue
        chain, end = [], start
        while end >= 0 and not is_done[end // 2]:
            is_done[end // 2] = True
            chain.append(end)
            end = int(partner[end ^ 1])
        chains.append(chain)
        are_rings.append(end >= 0)
    return chains, are_rings


def _points(chain, is_joined, offsets):
    """The points of the pieces of a chain; where two are joined, the place is there once."""
    result = []
    for end in chain:
        points = np.arange(offsets[end // 2], offsets[end // 2 + 1])
        result.append(points[::-1] if end % 2 else points)
    return [one[:-1] if k < len(result) - 1 or is_joined else one for k, one in enumerate(result)]


def check_grid(turns: int, per_tile: tuple[int, int], offset: Reals, shifted_rows: bool) -> None:
    """Raises ValueError for places in tiles that a turn about the corner of a tile does not leave as they are."""
    (columns, rows), (x, y) = per_tile, offset
    if turns == 1:
        return
    is_even = (2 * y) % 1 == 0 and (2 * x - (y if shifted_rows else 0)) % 1 == 0
    if turns != 2:
        is_even &= columns == rows and not shifted_rows and (x - y) % 1 == 0 and (turns == 4 or x % 1 == 0)
    if not is_even:
        raise ValueError(f"places in a tiling that turns must stay where they are: {ALLOWED[turns]}")


ALLOWED = {
    2: "offsets of 0 or 0.5; with shifted_rows twice the first one is the second, up to whole numbers",
    4: "as many columns as rows, not shifted, with an offset of (0, 0) or (0.5, 0.5)",
    6: "as many columns as rows, not shifted, with an offset of (0, 0)",
}


def directions(direction: tuple[int, int], turns: int) -> list[tuple[int, int]]:
    """The directions of lines that turns make of one: of two parallel ones, only one."""
    a, b = direction
    return {4: [(a, b), (-b, a)], 6: [(a, b), (-b, a + b), (-a - b, a)]}.get(turns, [(a, b)])
