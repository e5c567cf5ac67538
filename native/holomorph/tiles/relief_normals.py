"""The vectors by which a relief moves a surface."""

import numpy as np

from .. import _native
from ..mesh.hard_edges import is_hard

LONGEST = 2.0  # of the vectors by which vertices are moved, for a height of 1: at sharper corners they are shorter
SHARP = 29.0  # degrees, from which on an edge breaks the surface: those of a prism with twelve sides do
REFLEX = 1.1 * np.pi
PULL = 1e-6  # towards the mean normal, against 1 for all faces: decides where these leave a direction free


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
