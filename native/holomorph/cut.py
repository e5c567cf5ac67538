"""Maps cut along chosen edges, such as marked seams."""

import numpy as np

from ._native import TopologyError
from .checks import own_vertices
from .disk import PlaneMap
from .edges import edge_keys, edges_of_keys
from .truncated import TruncatedStructure


def cut_along(made, surface, component, cut_edges):
    """The structure with its map cut along the given edges instead of its seams. If the cut leaves several pieces, the
    UVs of each have a constant of their own; maps of disks are continuous and need no cut.

    cut_edges : (#S, 2) vertices of edges of faces; those on the boundary do not matter

    Raises TopologyError where two vertices are joined by no edge, or the map would still jump elsewhere.
    Cost: O(#C log #C), no solve.
    """
    given = np.asarray(cut_edges)
    if given.ndim != 2 or given.shape[1] != 2:
        raise TopologyError(f"cut_edges has the shape {given.shape}; (rows, 2) is needed, the vertices of each edge")
    vertices, labels = own_vertices(surface, component, given.ravel(), "cut vertex")
    edges = interior_edges(component, np.asarray(vertices, np.int64).reshape(-1, 2), given)
    if isinstance(made, PlaneMap):
        return made
    if isinstance(made, TruncatedStructure):
        raise TopologyError("the mesh is too coarse for a cut of your own: its punctures' stars meet; subdivide it")
    made._native.cut_along(edges.tolist(), labels)
    return made


def interior_edges(component, pairs, given):
    """Indices of the polygon edges between these (#S, 2) vertices, without those on the boundary; ascending."""
    corners, offsets = component.corner_vertices.astype(np.int64), component.face_offsets
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    count = len(component.vertex_index)
    sides, uses = np.unique(edge_keys(np.stack([corners, corners[following]], axis=1), count), return_counts=True)
    wanted = edge_keys(pairs, count)
    place = np.minimum(np.searchsorted(sides, wanted), len(sides) - 1)
    for a, b in given[sides[place] != wanted]:
        raise TopologyError(f"the cut runs between the vertices {a} and {b}, which no edge of a face joins")
    wanted = np.unique(wanted[uses[place] == 2])
    edges = component._native.edges
    diagonals = len(component.triangles) - (len(offsets) - 1)  # a polygon of n corners has n - 2 triangles
    return np.sort(edges_of_keys(edges[: len(edges) - diagonals], wanted, count))
