"""Disks, rings and rectangles, in the plane or bent."""

import families
import numpy as np


def flat(n, jitter=0.2):
    """The unit disk in the plane."""
    points, faces = families.hexagonal_disk(n, jitter)
    return families.uniform(np.column_stack([points, np.zeros(len(points))]), faces, ((0, 1),))


def ring(n):
    """`flat` without its inner half: two boundary loops."""
    mesh = flat(n, 0)
    faces = mesh.corners.reshape(-1, 3)
    kept = faces[np.linalg.norm(mesh.vertices[faces], axis=2).min(axis=1) > 0.5 - 1e-9]
    used, faces = np.unique(kept, return_inverse=True)
    return families.uniform(mesh.vertices[used], faces.reshape(-1, 3), ((0, 2),))


def grid(n, m, place=lambda x, y: np.stack([x, y, 0 * x], axis=1), shape="quads"):
    """n x m cells of the unit square, placed in space: vertex (i, j) has index i (m + 1) + j."""
    quads = families.grid_quads(n + 1, m + 1).reshape(n + 1, m + 1, 4)[:-1, :-1].reshape(-1, 4)
    i, j = np.divmod(np.arange((n + 1) * (m + 1)), m + 1)
    faces = quads if shape == "quads" else families.cut_quads(quads, alternate=True)
    return families.uniform(place(i / n, j / m), faces, ((0, 1),))


def corners_of(n, m):
    """Corners of `grid`, in order with the surface on the left, from (0, 0) along x."""
    return [0, n * (m + 1), n * (m + 1) + m, m]


def wavy(x, y):
    return np.stack([2 * x, y + 0.1 * np.sin(5 * x), 0.2 * np.cos(4 * x * y)], axis=1)
