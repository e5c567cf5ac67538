"""What islands keep: their faces, and lengths where they unfold."""

import numpy as np
from holomorph import free_boundary_map
from holomorph.mesh.edges import edge_keys
from holomorph.mesh.surgery import cut_open

ISOMETRIC = 1e-10  # relative


def free(surface, **options):
    return free_boundary_map(surface, **options)


def sides(surface):
    """(3 #T, 2) polygon corners at the ends of each triangle's sides."""
    corners = surface.triangle_corners
    return np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)


def stretches(surface, uv):
    """Length in the map over that in space of each triangle's sides."""
    ends = sides(surface)
    in_space = surface.vertices[surface.corner_vertices[ends]]
    return np.linalg.norm(np.diff(uv[ends], axis=1)[:, 0], axis=1) / np.linalg.norm(
        np.diff(in_space, axis=1)[:, 0], axis=1
    )


def is_rigid(surface):
    structure = free(surface)
    uv = structure.uv()
    isometric = np.abs(stretches(surface, uv) - 1).max() < ISOMETRIC
    return isometric and not structure.quality(uv).flipped.any()


def cut_along(surface, seams):
    """The parts into which seams, (n, 2) vertices of edges, cut a surface."""
    keys, wanted = (edge_keys(np.asarray(ends), len(surface.vertices)) for ends in (surface._native.edges, seams))
    return cut_open(surface, np.isin(keys, wanted)).components
