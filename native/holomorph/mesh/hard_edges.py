"""Where a surface breaks off or is folded: edges between faces that meet at an angle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _native
from ..core.array_types import Integers, Reals
from .edges import edge_keys
from .surface import Surface

SHARP = 150.0  # degrees between the normals of two faces: a fold, or a blade


def is_hard(surface, degrees):
    """(#E,) whether an edge bends by more than an angle."""
    return _native.bends(surface._native) > np.radians(degrees)


def cuts(parts: Sequence[Surface]) -> tuple[Integers, Integers, Reals, Reals]:
    """((2, n) parts, (2, n) sides of their triangles, numbered through in each, (n,) their length, (n,) how far a seam
    is seen there) of the edges at which these parts of one mesh are cut open, or from each other."""
    natives = [part._native for part in parts]
    first_edges = np.cumsum([0, *(len(native.edge_lengths) for native in natives)])
    first_sides = np.cumsum([0, *(3 * len(native.triangles) for native in natives)])
    edges = _joined(native.triangle_edges.ravel() + first for native, first in zip(natives, first_edges))
    border = np.flatnonzero(np.bincount(edges)[edges] == 1)
    of = np.searchsorted(first_sides, border, side="right") - 1
    vertices = _joined(part.vertex_index[native.triangles.ravel()] for part, native in zip(parts, natives))
    start, end = vertices[border], vertices[next_sides(border)]
    keys = edge_keys(np.stack([start, end], axis=1), parts[0].given_vertex_count)
    lengths = _joined(native.edge_lengths for native in natives)[edges[border]]
    normals = _joined(_native.face_normals(native)[native.triangle_faces] for native in natives)[border // 3]
    normals = normals * np.where(start < end, 1, -1)[:, None]  # as if all edges ran from the lower vertex on
    order = np.argsort(keys, kind="stable")
    both = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    pairs = np.stack([order[both], order[both + 1]])
    one, other = normals[pairs]
    sides = border[pairs] - first_sides[of[pairs]]
    return of[pairs], sides, lengths[pairs[0]], _native.seen(_angles(one, -other))


def _joined(arrays):
    return np.concatenate(list(arrays))


def _angles(one, other):
    """(n,) radians between (n, 3) vectors."""
    return np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other))


def next_sides(sides: Integers) -> Integers:
    """The side that follows each one in its triangle, numbered through all triangles."""
    return np.where(sides % 3 == 2, sides - 2, sides + 1)


def folds(surface, threads=0):
    """(#E,) whether an edge bends by more than `SHARP`, and a face beside it goes through another one. Blades and
    sheets with two sides bend, and do not cross."""
    result = np.zeros(len(surface._native.edges), bool)
    sharp = np.flatnonzero(is_hard(surface, SHARP))
    if len(sharp):
        crossing = np.unique(_native.crossings(surface.vertices, surface.triangles, threads=threads))
        result[sharp] = np.isin(sharp, surface._native.triangle_edges[crossing])
    return result
