"""Surfaces with boundary: the edges there, and what their matrices and maps are measured by."""

import numpy as np


def size(matrix):
    return np.abs(matrix).max()


def handles_of(structure):
    return 2 * structure.surface.genus


def least_eigenvalue(matrix):
    return np.linalg.eigvalsh((matrix + matrix.T) / 2).min()


def is_boundary_side(surface):
    """(#T, 3): side i of a triangle, from corner i to the next, is the only one between its two vertices."""
    ends = np.sort(np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1), axis=-1)
    keys = ends.astype(np.int64) @ [len(surface.vertices), 1]
    _, place, count = np.unique(keys, return_inverse=True, return_counts=True)
    return count[place].reshape(keys.shape) == 1


def boundary_edges(structure):
    """Indices of the edges on the boundary."""
    surface = structure.surface
    ends = np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1)[is_boundary_side(surface)]
    weights = [len(surface.vertices), 1]
    return np.flatnonzero(np.isin(structure.edges.astype(np.int64) @ weights, np.sort(ends, axis=1) @ weights))


def boundary_sides(structure):
    """(#, 2) corners at both ends of every boundary edge, in the triangle there."""
    surface = structure.surface
    corners = surface.triangle_corners
    return np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)[is_boundary_side(surface)]


def signed_area(structure, uv):
    p = uv[structure.surface.triangle_corners]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2


def boundary_mask(surface):
    """(#V,) bool, by counting the faces at each side."""
    triangles = surface.triangles
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    rows, count = np.unique(sides, axis=0, return_counts=True)
    mask = np.zeros(len(surface.vertices), dtype=bool)
    mask[rows[count == 1]] = True
    return mask
