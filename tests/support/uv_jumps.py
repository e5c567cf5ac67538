"""Jumps of UVs across edges, and areas."""

import numpy as np


def corner_sides(surface):
    """Every polygon corner and the next one in its polygon."""
    following = np.arange(1, len(surface.corner_vertices) + 1)
    following[surface.face_offsets[1:] - 1] = surface.face_offsets[:-1]
    return np.arange(len(following)), following


def pairs_of_sides(surface):
    """(#E, 2) corners at which the two sides of every polygon edge start, and the edge's ends by key."""
    start, end = corner_sides(surface)
    ends = np.sort(np.stack([surface.corner_vertices[start], surface.corner_vertices[end]], axis=1), axis=1)
    keys = ends.astype(np.int64) @ [len(surface.vertices), 1]
    order = np.argsort(keys, kind="stable").reshape(-1, 2)
    return order, keys[order[:, 0]]


def jumps(surface, uv):
    """(#E, 2, 2): difference of the UVs on the two sides of every polygon edge, at both of its ends."""
    order, keys = pairs_of_sides(surface)
    _, following = corner_sides(surface)
    near, far = order.T
    same = (
        surface.corner_vertices[near] == surface.corner_vertices[far]
    )  # sides read in the same direction: repaired faces
    at_start = uv[np.where(same, far, following[far])] - uv[near]
    at_end = uv[np.where(same, following[far], far)] - uv[following[near]]
    return np.stack([at_start, at_end], axis=1), keys


def triangle_areas(surface, uv):
    """Signed UV area of each triangle."""
    p = uv[surface.triangle_corners]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
