"""Edges found by their ends, and those of the boundary."""

import numpy as np


def edge_keys(ends, vertex_count):
    """One int64 for each pair of vertices, (#, 2) in either order: equal for equal pairs, ascending lexicographically
    with the lower vertex first."""
    ends = np.asarray(ends, np.int64)
    return ends.min(axis=1) * vertex_count + ends.max(axis=1)


def are_among(edges, ends, vertex_count):
    """(#E,) whether each of the edges, (#E, 2) vertices, has one of these pairs of ends, (n, 2); others are ignored."""
    ends = np.asarray(ends, np.int64)
    ends = ends[((ends >= 0) & (ends < vertex_count)).all(axis=1)]
    return np.isin(edge_keys(edges, vertex_count), edge_keys(ends, vertex_count))


def edges_of_keys(edges, keys, vertex_count):
    """Index into `edges`, (#E, 2) vertices, of the edge with each of the keys. @pre every key is that of one edge only

    Cost: O((#E + #keys) log #E)."""
    known = edge_keys(edges, vertex_count)
    order = np.argsort(known)
    return order[np.searchsorted(known, keys, sorter=order)]


def polygon_sides(mesh):
    """(#C, 2) int64 vertices of the side from each polygon corner to the next one of its polygon."""
    corners = mesh.corner_vertices.astype(np.int64)
    return np.stack([corners, corners[following_corners(mesh)]], axis=1)


def following_corners(mesh):
    """(#C,) the next corner after each one in its polygon."""
    following = np.arange(1, len(mesh.corner_vertices) + 1)
    following[mesh.face_offsets[1:] - 1] = mesh.face_offsets[:-1]
    return following


def boundary_corners(surface):
    """(#B, 2) corners of the surface's polygons at the ends of the sides that no other polygon has, in the direction of
    its triangles."""
    edges = surface._native.triangle_edges.ravel()
    corners = surface.triangle_corners
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)
    return ends[np.bincount(edges)[edges] == 1]


def boundary_edges(surface):
    """(#B, 2) vertices of the edges of the boundary, in the direction of their triangles."""
    return surface.corner_vertices[boundary_corners(surface)]


def around_boundary(surface, vertices):
    """The vertices, (n,) integers, in the order in which the boundary loop of the first passes them, surface on the
    left; as they are where they do not lie on one loop.

    Steps to the first vertex by pointer doubling, O(#V log #B).
    """
    start, end = boundary_edges(surface).astype(np.int64).T
    if not len(vertices) or not np.isin(vertices, start).all():
        return vertices
    following = np.arange(start.max() + 1)
    following[start] = end
    following[vertices[0]] = vertices[0]
    steps = np.ones(len(following), np.int64)
    steps[vertices[0]] = 0
    for _ in range(len(start).bit_length()):
        steps[start], following[start] = steps[start] + steps[following[start]], following[following[start]]
    if (following[vertices] != vertices[0]).any():
        return vertices
    return vertices[np.concatenate([[0], 1 + np.argsort(-steps[vertices[1:]], kind="stable")])]
