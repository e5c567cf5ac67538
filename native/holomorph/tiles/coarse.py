"""Coarse solids with smaller triangles: the same surface, with room for poles and for what fades around them."""

import numpy as np

from ..mesh.surface import Surface

FEW = 200  # triangles: the star of a pole is to be a small part of all


def with_room(surface):
    """A closed part without handles with its triangles cut in four, at the midpoints of their sides, until they are not
    few; others as they are."""
    if surface.genus or surface.boundary_count:
        return surface
    while len(surface.triangles) < FEW:
        surface = _quartered(surface)
    return surface


def _quartered(surface):
    native, corners = surface._native, surface.triangles
    middle = len(surface.vertices) + native.triangle_edges  # of the sides from each corner to the next
    at_corners = np.stack([corners, middle, np.roll(middle, 1, axis=1)], axis=2).reshape(-1, 3)
    middles = surface.vertices[native.edges].mean(axis=1)
    return Surface(np.concatenate([surface.vertices, middles]), np.concatenate([at_corners, middle]))
