"""Maps cut along the caller's own edges, such as the seams that an artist has marked."""

import numpy as np

from ._native import TopologyError
from .disk import PlaneMap
from .results import own_vertices
from .truncated import TruncatedStructure


def cut_along(made, surface, component, cut_edges):
    """The structure with the cut that runs along the given edges, instead of one of our own. Where the cut leaves
    several pieces, each starts at a UV of its own; maps of disks are continuous and need no cut.

    cut_edges : (#S, 2) vertices of edges of faces; those on the boundary do not matter

    Raises TopologyError where two vertices are joined by no edge, or the map would still jump elsewhere.
    Cost: O(#C log #C), no solve.
    """
    given = np.asarray(cut_edges)
    if given.ndim != 2 or given.shape[1] != 2:
        raise TopologyError(f"cut_edges has the shape {given.shape}; (rows, 2) is needed, the vertices of each edge")
    vertices, names = own_vertices(surface, component, given.ravel(), "cut vertex")
    edges = interior_edges(component, np.asarray(vertices, np.int64).reshape(-1, 2), given)
    if isinstance(made, PlaneMap):
        return made
    if isinstance(made, TruncatedStructure):
        raise TopologyError("the mesh is too coarse for a cut of your own: its punctures' stars meet; subdivide it")
    made._native.cut_along(edges.tolist(), names)
    return made


def interior_edges(component, pairs, given):
    """Indices of the polygon edges between these (#S, 2) vertices, without those on the boundary; ascending."""
    corners, offsets = component.corner_vertices.astype(np.int64), component.face_offsets
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    count = len(component.vertex_index)

    def keys(ends):
        return ends.min(axis=1) * count + ends.max(axis=1)

    sides, uses = np.unique(keys(np.stack([corners, corners[following]], axis=1)), return_counts=True)
    wanted = keys(pairs)
    place = np.minimum(np.searchsorted(sides, wanted), len(sides) - 1)
    for a, b in given[sides[place] != wanted]:
        raise TopologyError(f"the cut runs between the vertices {a} and {b}, which no edge of a face joins")
    wanted = np.unique(wanted[uses[place] == 2])
    edges = component._native.edges.astype(np.int64)
    diagonals = len(component.triangles) - (len(offsets) - 1)  # a polygon of n corners has n - 2 triangles
    numbers = keys(edges[: len(edges) - diagonals])
    order = np.argsort(numbers)
    return np.sort(order[np.searchsorted(numbers, wanted, sorter=order)])
