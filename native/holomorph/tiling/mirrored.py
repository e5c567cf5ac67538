"""Turned tilings that mirror themselves as their surface does: one half is solved, whose rows end at the plane."""

from __future__ import annotations

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core.array_types import Integers, Reals
from ..mesh.edges import boundary_edges
from ..mesh.mirror import mirror_of
from ..mesh.surface import Surface

REFLECTION = np.array([-1.0, 1.0])  # of UVs: u runs the other way


class Half:
    """Half of a surface that mirrors itself, and how tilings of it become those of the whole.

    native : the half; lines : its edges in the plane

    Raises TopologyError for a surface that does not mirror itself, or whose half falls apart.
    """

    native: _native.Surface
    lines: Integers

    def __init__(self, surface: Surface) -> None:
        mirror = mirror_of(surface)
        if mirror is None:
            raise TopologyError('lines is "mirror", and this surface does not mirror itself in a vertical plane')
        sizes = np.diff(surface.face_offsets)
        self._surface, self._mirror = surface, mirror
        self._corners = np.flatnonzero(np.repeat(mirror.half, sizes))
        self._vertices, own = np.unique(surface.corner_vertices[self._corners], return_inverse=True)
        offsets = np.concatenate([[0], np.cumsum(sizes[mirror.half])])
        self.native = _native.Surface.from_polygons(surface.vertices[self._vertices], own, offsets)
        if self.native.component_count > 1:
            raise TopologyError('lines is "mirror", and half of this surface falls apart')
        self.lines = np.flatnonzero(mirror.on_plane[self._vertices][self.native.edges].all(axis=1))

    def unfolded(self, uv: Reals) -> Reals:
        """(#C, 2) UVs of the whole. A row that ends at u = c in the plane goes on when it is moved by 2c, one that ends
        at v = c when it is turned by half as well."""
        result = np.empty((len(self._surface.corner_vertices), 2))
        result[self._corners] = uv
        result[self._mirror.corners[self._corners]] = REFLECTION * uv
        return result

    def cones(self, cones: Integers, missing: Integers, uv: Reals, turns: int) -> tuple[Integers, Integers]:
        """(vertices, what is missing there) of the whole: those of the half, twice, and those in the plane."""
        inside = self._vertices[cones]
        inside = np.concatenate([inside, self._mirror.vertices[inside]])
        at = (self.unfolded(uv) @ [1, 1j])[self._surface.triangle_corners]
        corners = np.angle((np.roll(at, 1, axis=1) - at) * np.conj(np.roll(at, -1, axis=1) - at)) / (2 * np.pi)
        around = np.bincount(self._surface.triangles.ravel(), corners.ravel(), len(self._mirror.vertices))
        lacking = np.rint((1 - around) * turns).astype(int)
        is_inner = np.ones(len(lacking), bool)
        is_inner[boundary_edges(self._surface).ravel()] = False
        plane = np.flatnonzero(self._mirror.on_plane & is_inner & (lacking != 0))
        return np.concatenate([inside, plane]), np.concatenate([missing, missing, lacking[plane]])


def jumps_of(surface: Surface, uv: Reals, turns: int) -> Integers:
    """(#S, 4): the edges across which UVs in coordinates of the square lattice jump, ascending, the turns, and the
    translations, as in `Tiling.jumps`."""
    edges = surface._native.triangle_edges.ravel()
    corners, triangles = surface.triangle_corners, surface.triangles
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    is_left = (triangles < np.roll(triangles, -1, axis=1)).ravel()  # it runs along the edge, from the lower vertex on
    z = uv @ [1, 1j]
    low, high = np.where(is_left, z[start], z[end]), np.where(is_left, z[end], z[start])
    order = np.lexsort((~is_left, edges))
    pairs = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    left, right = order[pairs], order[pairs + 1]
    along = high - low
    turn = np.rint(np.angle(along[right] * np.conj(along[left])) * turns / (2 * np.pi)).astype(int) % turns
    by = low[right] - np.array([1, 1j, -1, -1j])[turn * 4 // turns] * low[left]
    jumps = np.column_stack([edges[left], turn, np.rint(by.real), np.rint(by.imag)]).astype(int)
    return jumps[jumps[:, 1:].any(axis=1)]
