"""Where a surface breaks off: edges between faces that meet at an angle, and tips that only a cut can flatten."""

import numpy as np

from .cut_open import on_border, paths_to_border

TIP = np.pi / 3  # radians that are missing around a vertex, or too many
HIDING = np.pi / 3  # radians, from which on the bend hides a seam; where it is less, in proportion


def is_hard(surface, degrees):
    """(#E,) whether an edge bends by more than an angle."""
    return bends(surface) > np.radians(degrees)


def bends(surface):
    """(#E,) radians by which the normals of the two faces of an edge differ; 0 for diagonals and on the boundary."""
    normals = _face_normals(surface)
    edges, faces = surface._native.triangle_edges.ravel(), np.repeat(surface.triangle_faces, 3)
    order = np.argsort(edges, kind="stable")
    both = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, other = normals[faces[order[both]]], normals[faces[order[both + 1]]]
    bend = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other))
    result = np.zeros(len(surface._native.edges))
    result[edges[order[both]]] = bend
    return result


def seen(bent):
    """How far a seam is seen along edges with these `bends`: from 0 where they hide it to 1 across the smooth."""
    return np.maximum(1 - bent / HIDING, 0)


def cuts_to_tips(surface, is_seam):
    """(#E,) the shortest paths of the polygons' edges from the seams, a mask of edges, and from the boundary to the
    tips of the parts that they leave."""
    is_on_border = on_border(surface, is_seam)
    tips = (np.abs(_defects(surface)) > TIP) & ~is_on_border
    return paths_to_border(surface, is_on_border, tips)


def curvature(surface, most=np.inf):
    """The sum over the inner vertices of the angle that is missing around each, or too much, in radians.

    most : vertices where it is more do not count, such as `TIP`
    """
    no_seam = np.zeros(len(surface._native.edges), bool)
    missing = np.abs(_defects(surface)[~on_border(surface, no_seam)])
    return float(missing[missing <= most].sum())


def _face_normals(surface):
    """(#F, 3) unit vectors, by the mean of the triangles; zero for faces without area."""
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    cross = np.cross(b - a, c - a)
    count = len(surface.face_offsets) - 1
    sums = np.stack([np.bincount(surface.triangle_faces, column, count) for column in cross.T], axis=1)
    size = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.divide(sums, size, out=np.zeros_like(sums), where=size > 0)


def _defects(surface):
    """(#V,) 2 pi less the angles at each vertex."""
    points = surface.vertices[surface.triangles]
    one, other = np.roll(points, -1, axis=1) - points, np.roll(points, 1, axis=1) - points
    angles = np.arctan2(np.linalg.norm(np.cross(one, other), axis=2), np.einsum("tij,tij->ti", one, other))
    return 2 * np.pi - np.bincount(surface.triangles.ravel(), angles.ravel(), len(surface.vertices))
