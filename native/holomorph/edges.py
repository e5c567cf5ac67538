"""Edges found by their ends."""

import numpy as np


def edge_keys(ends, vertex_count):
    """One int64 for each pair of vertices, (#, 2) in either order: equal for equal pairs, ascending lexicographically
    with the lower vertex first."""
    ends = ends.astype(np.int64)
    return ends.min(axis=1) * vertex_count + ends.max(axis=1)


def edges_of_keys(edges, keys, vertex_count):
    """Index into `edges`, (#E, 2) vertices, of the edge with each of the keys. @pre every key is that of one edge only

    Cost: O((#E + #keys) log #E)."""
    known = edge_keys(edges, vertex_count)
    order = np.argsort(known)
    return order[np.searchsorted(known, keys, sorter=order)]


def boundary_corners(surface):
    """(#B, 2) corners of the surface's polygons at the ends of the sides that no other polygon has, in the direction of
    its triangles."""
    edges = surface._native.triangle_edges.ravel()
    corners = surface.triangle_corners
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)
    return ends[np.bincount(edges)[edges] == 1]
