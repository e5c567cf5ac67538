"""Where a surface breaks off: edges between faces that meet at an angle, and tips that only a cut can flatten."""

import numpy as np

from .cut_open import next_sides, on_border, paths_to_border
from .edges import edge_keys

TIP = np.pi / 3  # radians that are missing around a vertex, or too many
HIDING = np.pi / 3  # radians, from which on the bend hides a seam; where it is less, in proportion


def is_hard(surface, degrees):
    """(#E,) whether an edge bends by more than an angle."""
    return bends(surface) > np.radians(degrees)


def bends(surface):
    """(#E,) radians by which the normals of the two faces of an edge differ; 0 for diagonals and on the boundary."""
    normals, (edges, one, other) = _face_normals(surface), faces_of_edges(surface)
    result = np.zeros(len(surface._native.edges))
    result[edges] = angles(normals[one], normals[other])
    return result


def faces_of_edges(surface):
    """((n,) the edges that are not on the boundary, (n,) the faces to one side of each, (n,) to the other)."""
    edges, faces = surface._native.triangle_edges.ravel(), np.repeat(surface.triangle_faces, 3)
    order = np.argsort(edges, kind="stable")
    both = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    return edges[order[both]], faces[order[both]], faces[order[both + 1]]


def angles(one, other):
    """(n,) radians between (n, 3) vectors."""
    return np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other))


def seen(bent):
    """How far a seam is seen along edges with these `facets.breaks`: from 0, hidden, to 1 across the smooth."""
    return np.maximum(1 - bent / HIDING, 0)


def cuts(parts):
    """((2, n) parts, (2, n) sides of their triangles, numbered through, (n,) their length, (n,) how far a seam is seen
    there) of the edges at which these parts of one mesh are cut open, or from each other."""
    borders = list(map(_border, parts))
    of = np.repeat(np.arange(len(parts)), [len(border[0]) for border in borders])
    sides, keys, lengths, normals = map(np.concatenate, zip(*borders))
    order = np.argsort(keys, kind="stable")
    both = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    pairs = np.stack([order[both], order[both + 1]])
    one, other = normals[pairs]
    return of[pairs], sides[pairs], lengths[pairs[0]], seen(angles(one, -other))


def cuts_to_tips(surface, is_seam):
    """(#E,) the shortest paths of the polygons' edges from the seams, a mask of edges, and from the boundary to the
    tips of the parts that they leave."""
    is_on_border = on_border(surface, is_seam)
    tips = (np.abs(_defects(surface)) > TIP) & ~is_on_border
    return paths_to_border(surface, is_on_border, tips)


def curvature(surface, is_seam=None, most=np.inf):
    """The sum over the inner vertices of the angle that is missing around each, or too much, in radians.

    is_seam : (#E,) edges whose vertices do not count
    most : vertices where it is more do not count, such as `TIP`
    """
    is_seam = np.zeros(len(surface._native.edges), bool) if is_seam is None else is_seam
    missing = np.abs(_defects(surface)[~on_border(surface, is_seam)])
    return float(missing[missing <= most].sum())


def _border(surface):
    """(sides of triangles on the boundary; names of the edges there, equal for the same vertices of the mesh as given;
    their lengths; normals of their faces, as if all ran from the lower vertex to the other)."""
    edges = surface._native.triangle_edges.ravel()
    sides = np.flatnonzero(np.bincount(edges)[edges] == 1)
    start, end = surface.vertex_index[surface.triangles.ravel()[np.stack([sides, next_sides(sides)])]]
    keys = edge_keys(np.stack([start, end], axis=1), surface.given_vertex_count)
    normals = _face_normals(surface)[surface.triangle_faces[sides // 3]] * np.where(start < end, 1, -1)[:, None]
    return sides, keys, surface._native.edge_lengths[edges[sides]], normals


def _face_normals(surface):
    """(#F, 3) unit vectors, by the mean of the triangles; slivers have that of the face to whose piece they belong."""
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    cross = np.cross(b - a, c - a)
    count = len(surface.face_offsets) - 1
    sums = np.stack([np.bincount(surface.triangle_faces, column, count) for column in cross.T], axis=1)
    size = np.linalg.norm(sums, axis=1, keepdims=True)
    normals = np.divide(sums, size, out=np.zeros_like(sums), where=size > 0)
    return normals[surface._native.sliver_owners()]


def _defects(surface):
    """(#V,) 2 pi less the angles at each vertex; of vertices at one place that edges join, the sum, at the lowest."""
    points = surface.vertices[surface.triangles]
    one, other = np.roll(points, -1, axis=1) - points, np.roll(points, 1, axis=1) - points
    angles = np.arctan2(np.linalg.norm(np.cross(one, other), axis=2), np.einsum("tij,tij->ti", one, other))
    is_point = ~one.any(axis=2)  # a side without length, at whose ends the angles are a right one each in the limit
    angles += np.pi / 2 * (is_point | np.roll(is_point, 1, axis=1))
    defects = 2 * np.pi - np.bincount(surface.triangles.ravel(), angles.ravel(), len(surface.vertices))
    if is_point.any():
        place = _places(surface)
        defects = np.where(place == np.arange(len(place)), np.bincount(place, defects, len(place)), 0.0)
    return defects


def _places(surface):
    """(#V,) the lowest of the vertices that edges without length join to each."""
    ends = np.asarray(surface._native.edges)[surface._native.edge_lengths == 0]
    place, before = np.arange(len(surface.vertices)), None
    while not np.array_equal(place, before):
        before = place.copy()
        np.minimum.at(place, ends, place[ends].min(axis=1)[:, None])
        place = place[place]
    return place
