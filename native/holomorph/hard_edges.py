"""Where a surface breaks off: edges between faces that meet at an angle, and tips that only a cut can flatten."""

import numpy as np

TIP = np.pi / 3  # radians that are missing around a vertex, or too many


def is_hard(surface, degrees):
    """(#E,) whether the normals of the two faces of an edge differ by more than an angle; never for diagonals."""
    normals = _face_normals(surface)
    edges, faces = surface._native.triangle_edges.ravel(), np.repeat(surface.triangle_faces, 3)
    order = np.argsort(edges, kind="stable")
    both = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, other = normals[faces[order[both]]], normals[faces[order[both + 1]]]
    bend = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other))
    result = np.zeros(len(surface._native.edges), bool)
    result[edges[order[both]]] = bend > np.radians(degrees)
    return result


def cuts_to_tips(surface, is_seam):
    """(#E,) the shortest paths of the polygons' edges from the seams, a mask of edges, and from the boundary to the
    tips of the parts that they leave."""
    native, count = surface._native, len(surface.vertices)
    edges = np.asarray(native.edges, np.int64)
    is_border = is_seam | (np.bincount(native.triangle_edges.ravel(), minlength=len(edges)) == 1)
    on_border = np.zeros(count, bool)
    on_border[edges[is_border]] = True
    tips = (np.abs(_defects(surface)) > TIP) & ~on_border
    result = np.zeros(len(edges), bool)
    if not tips.any() or not on_border.any():
        return result
    lengths = np.array(native.edge_lengths)
    lengths[native.polygon_edge_count :] = np.inf
    distances = native.edge_distances(lengths, np.flatnonzero(on_border).tolist())
    nearer, edge_to_it = _steps(edges[: native.polygon_edge_count], lengths, distances)
    path, place = tips & np.isfinite(distances), nearer
    for _ in range(count.bit_length()):  # after k rounds the first 2^k vertices of each path are marked
        path[place[path]] = True
        place = place[place]
    result[edge_to_it[path & (nearer != np.arange(count))]] = True
    return result


def _steps(edges, lengths, distances):
    """(#V,) the next vertex on a shortest path to the sources, itself where there is none, and (#V,) the edge to it."""
    ends = np.concatenate([edges, edges[:, ::-1]])
    through = distances[ends[:, 1]] + np.tile(lengths[: len(edges)], 2)
    is_step = (through == distances[ends[:, 0]]) & (distances[ends[:, 1]] < distances[ends[:, 0]])
    nearer, edge_to_it = np.arange(len(distances)), np.zeros(len(distances), np.int64)
    nearer[ends[is_step, 0]] = ends[is_step, 1]
    edge_to_it[ends[is_step, 0]] = np.tile(np.arange(len(edges)), 2)[is_step]
    return nearer, edge_to_it


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
