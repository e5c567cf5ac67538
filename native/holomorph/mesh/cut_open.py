"""Surfaces cut open along their edges, and paths of edges along which to cut."""

import numpy as np

from .. import _native
from ..core import arrays
from .origin import Origin
from .surface import Surface

SHORTEST = 1e-12  # of the longest edge: no edge is shorter to a path, which goes on where two vertices are at one place


def cut_open(surface, is_seam):
    """Cuts the surface open along the edges of this mask, (#E,), but leaves no sliver without the neighbour at its
    longest side: no part is without area."""
    is_seam = surface._native.cut_without_sliver_parts(is_seam).astype(bool)
    index, new = parted_vertices(surface, is_seam)
    corner_vertices = np.empty(len(surface.corner_vertices), np.int32)
    corner_vertices[surface.triangle_corners.ravel()] = new
    native = _native.Surface.from_polygons(surface.vertices[index], corner_vertices, surface.face_offsets)
    vertex_index = arrays.frozen(surface.vertex_index[index])
    origin = Origin(vertex_index, surface.face_index, surface.corner_index, surface.given_vertex_count, up=surface.up)
    return Surface._of(native, origin)


def parted_vertices(surface, is_seam):
    """((n,) vertices of the surface that those are copies of which it has when it is cut along the edges of this mask,
    (3 #T,) the copy at each triangle corner)."""
    vertices = surface.triangles.ravel().astype(np.int64)
    fans = _fans(surface._native.triangle_edges, is_seam, int(np.bincount(vertices).max()))
    _, first, new = np.unique(vertices * len(fans) + fans, return_index=True, return_inverse=True)
    return vertices[first], new.ravel()


def _fans(triangle_edges, is_seam, most):
    """(3 #T,) a name for the fan of each triangle corner: corners of one vertex have the same where one comes from one
    to the other through triangles, and across no seam.

    The corner at the start of side h of a triangle is followed by that of the triangle across this side: a fan is a
    path or a cycle of corners, and its name the end of the path or the lowest corner of the cycle; by pointer doubling.
    No fan has more than `most` corners.
    """
    edges = triangle_edges.ravel()
    corners = np.arange(len(edges))
    order = np.argsort(edges, kind="stable")
    pairs = np.flatnonzero((edges[order[1:]] == edges[order[:-1]]) & ~is_seam[edges[order[1:]]])
    one, other = order[pairs], order[pairs + 1]
    following = corners.copy()
    following[one], following[other] = next_sides(other), next_sides(one)
    place, lowest = following, corners
    for _ in range(most.bit_length()):
        lowest, place = np.minimum(lowest, lowest[place]), place[place]
    return np.where(following[place] == place, place, lowest)


def next_sides(sides):
    """The side that follows each one in its triangle, numbered through all triangles."""
    return np.where(sides % 3 == 2, sides - 2, sides + 1)


def on_border(surface, is_seam):
    """(#V,) whether a vertex lies on the boundary or at one of the seams, a mask of edges."""
    edges = np.asarray(surface._native.edges)
    is_border = is_seam | (np.bincount(surface._native.triangle_edges.ravel(), minlength=len(edges)) == 1)
    result = np.zeros(len(surface.vertices), bool)
    result[edges[is_border]] = True
    return result


def paths_to_border(surface, is_on_border, starts):
    """(#E,) the shortest paths of the polygons' edges from these vertices, a mask, to those of the border, another."""
    native, count = surface._native, len(surface.vertices)
    edges = np.asarray(native.edges, np.int64)
    result = np.zeros(len(edges), bool)
    if not starts.any() or not is_on_border.any():
        return result
    lengths = np.array(native.edge_lengths)
    lengths = np.maximum(lengths, SHORTEST * lengths.max())
    lengths[native.polygon_edge_count :] = np.inf
    distances = native.edge_distances(lengths, np.flatnonzero(is_on_border).tolist())
    nearer, edge_to_it = _steps(edges[: native.polygon_edge_count], lengths, distances)
    path, place = starts & np.isfinite(distances), nearer
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
