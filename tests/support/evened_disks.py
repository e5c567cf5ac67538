"""A disk to even, its border, and the jumps of its maps."""

import families
import numpy as np
from holomorph import Surface


def bumpy_disk(height=0.6):
    points, faces = families.hexagonal_disk(12, jitter=0.15)
    x, y = points.T
    return Surface(np.column_stack([points, height * np.sin(4 * x) * np.cos(3 * y)]), faces)


def jumps(native, uv):
    """(#, 2) of all corners: what uv has more than at the first corner of its vertex."""
    vertices, first = np.unique(native.corner_vertices, return_index=True)
    return uv - uv[first[np.searchsorted(vertices, native.corner_vertices)]]


def rim(native):
    edges = native.edges[np.bincount(native.triangle_edges.ravel(), minlength=len(native.edges)) == 1]
    return np.unique(edges)
