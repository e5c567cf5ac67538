"""The double cover of a surface with boundary (paper § 8)."""

import numpy as np

from . import arrays
from ._native import TopologyError
from .checks import check_type
from .surface import Surface


def double_cover(surface: Surface) -> Surface:
    """Two copies of a surface, the second one with the other orientation, glued along all boundary loops: closed, and
    of genus 2g + b - 1 where the surface is connected.

    Edges are matched by index, so that a chord, an inner edge with both ends on the boundary, gives two edges with the
    same ends. Hence the result is an intrinsic surface, of triangles and edge lengths without positions. Its first #V
    vertices and #T triangles are those of `surface`; triangle #T + t lies over triangle t.

    Parameters
    ----------
    surface : Surface with boundary, of one or several components

    Returns
    -------
    Surface
        With `dual_vertex`, (#V of the double,): the same vertex in the other copy, itself on the boundary.

    Raises
    ------
    TopologyError
        if the surface has no boundary.

    Cost: linear.
    """
    check_type(surface, Surface)
    native = surface._native
    triangles, sides = native.triangles.astype(np.int64), native.triangle_edges.astype(np.int64)
    edges, lengths = native.edges, native.edge_lengths
    on_boundary = np.bincount(sides.ravel(), minlength=len(edges)) == 1
    if not on_boundary.any():
        raise TopologyError("the surface has no boundary along which two copies of it could be glued")
    shared = np.zeros(native.vertex_count, dtype=bool)
    shared[edges[on_boundary]] = True
    shared[native.isolated_vertices] = True  # vertices of no triangle have no second copy
    dual_vertex, dual_edge = _second_copy(shared), _second_copy(on_boundary)
    faces = np.concatenate([triangles, dual_vertex[triangles][:, [0, 2, 1]]])
    opposite = np.concatenate([sides[:, [1, 2, 0]], dual_edge[sides][:, [1, 0, 2]]])  # corner i lies opposite entry i
    all_lengths = np.empty(max(len(edges), dual_edge.max() + 1))
    all_lengths[: len(edges)] = lengths
    all_lengths[dual_edge] = lengths
    double = Surface.from_edge_lengths(faces, all_lengths[opposite], opposite)
    both = np.arange(double._native.vertex_count)
    both[: len(dual_vertex)] = dual_vertex
    both[dual_vertex] = np.arange(len(dual_vertex))
    double.dual_vertex = arrays.frozen(both)
    return double


def _second_copy(shared):
    """Index of each element in the second copy: its own where it is shared, after all those of the first else."""
    count = len(shared)
    return np.where(shared, np.arange(count), count - 1 + np.cumsum(~shared))
