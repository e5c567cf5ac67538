"""Surfaces cut and glued: the double cover of one with boundary (paper § 8), small holes, cuts along edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import InvalidMesh, TopologyError
from ..core import arrays
from ..core.array_types import Reals
from .checks import check_type, only_component, own_vertices
from .edges import boundary_edges, edge_keys, polygon_sides
from .origin import Origin
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
    Source: Gu, Wang, Yau (2003), § 8.

    Examples
    --------
    >>> square = holomorph.Surface([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> double = holomorph.double_cover(square)
    >>> print(double.genus, double.boundary_count, double.dual_vertex)
    0 0 [0 1 2 3]
    """
    check_type(surface, Surface)
    native = surface._native
    on_boundary = np.bincount(native.triangle_edges.ravel(), minlength=len(native.edges)) == 1
    if not on_boundary.any():
        raise TopologyError("the surface has no boundary along which two copies of it could be glued")
    faces, lengths, names, dual_vertex = glued_copies(native, on_boundary)
    double = Surface.from_edge_lengths(faces, lengths, names)
    both = np.arange(double._native.vertex_count)
    both[: len(dual_vertex)] = dual_vertex
    both[dual_vertex] = np.arange(len(dual_vertex))
    double.dual_vertex = arrays.frozen(both)
    return double


def glued_copies(native, is_glued):
    """Two copies of a native surface, the second one turned over, glued along some boundary edges: (2 #T, 3) faces,
    lengths and names of edges opposite corners, and the vertex of the second copy over each."""
    triangles, sides = native.triangles.astype(np.int64), native.triangle_edges.astype(np.int64)
    shared = np.zeros(native.vertex_count, dtype=bool)
    shared[native.edges[is_glued]] = True
    shared[native.isolated_vertices] = True  # vertices of no triangle have no second copy
    dual_vertex, dual_edge = _second_copy(shared), _second_copy(is_glued)
    faces = np.concatenate([triangles, dual_vertex[triangles][:, [0, 2, 1]]])
    opposite = np.concatenate([sides[:, [1, 2, 0]], dual_edge[sides][:, [1, 0, 2]]])  # corner i lies opposite entry i
    lengths = np.empty(max(len(is_glued), dual_edge.max() + 1))
    lengths[: len(is_glued)] = native.edge_lengths
    lengths[dual_edge] = native.edge_lengths
    return faces, lengths[opposite], opposite, dual_vertex


def symmetrised(double: Surface, forms: ArrayLike) -> Reals:
    """The symmetric parts of forms on a double (paper Eq. 12): half the sum of the values on each edge and on its dual,
    which is the edge over it in the other copy, from the dual of its first vertex to that of the second.

    Those of harmonic forms are harmonic on the surface itself, whose edges are the first of the double's, with nothing
    fixed along its boundary; what is left, `forms` minus these, is zero there.

    Parameters
    ----------
    double : result of `double_cover`
    forms : (..., #E) reals on its edges, for the direction from the lower to the higher vertex

    Returns
    -------
    (..., #E) reals

    Raises
    ------
    TopologyError
        if `double` is not a double cover.
    ValueError
        if `forms` has another number of values.

    Source: Gu, Wang, Yau (2003), § 8 and Eq. 12.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> holed = holomorph.punch_holes(surface, [0])
    >>> double = holomorph.double_cover(holed)
    >>> forms = holomorph.conformal_structure(double).harmonic_forms
    >>> print(holomorph.symmetrised(double, forms).shape == forms.shape)
    True
    """
    check_type(double, Surface, "double")
    if double.dual_vertex is None:
        raise TopologyError("the surface is not a double_cover; only the edges of one have duals")
    forms, count = arrays.numbers(forms, "forms"), len(double._native.edges)
    if forms.ndim == 0 or forms.shape[-1] != count:
        raise ValueError(f"forms has the shape {forms.shape}; (..., {count}) is needed")
    dual_edge, sign = _dual_edges(double._native)
    return arrays.frozen((forms + sign * forms[..., dual_edge]) / 2)


def _dual_edges(native):
    """(#E,) the edge over each, and 1 or -1 as its direction is that of the dual vertices or not. A side of a triangle
    lies over that of the triangle over it, in reverse."""
    triangles, sides = native.triangles, native.triangle_edges
    start, end = triangles, np.roll(triangles, -1, axis=1)
    is_first = np.zeros(sides.size, dtype=bool)
    is_first[np.unique(sides, return_index=True)[1]] = True
    along = np.where((start < end) | ((start == end) & is_first.reshape(sides.shape)), 1, -1)
    (below, over), (along_below, along_over) = np.split(sides, 2), np.split(along, 2)
    dual_edge, sign = np.empty(len(native.edges), np.int64), np.empty(len(native.edges), np.int64)
    for one, other in ((below, over[:, ::-1]), (over[:, ::-1], below)):
        dual_edge[one], sign[one] = other, -along_below * along_over[:, ::-1]
    return dual_edge, sign


def _second_copy(shared):
    """Index of each element in the second copy: its own where it is shared, after all those of the first else."""
    count = len(shared)
    return np.where(shared, np.arange(count), count - 1 + np.cumsum(~shared))


def punch_holes(surface: Surface, vertices: ArrayLike) -> Surface:
    """The connected surface without the polygons at these vertices: of the same genus, with one boundary loop more for
    each of them.

    Parameters
    ----------
    surface : Surface, with positions
    vertices : (k,) integers, inner vertices; their polygons share no vertex, and none with the boundary

    Returns
    -------
    Surface
        Numbered anew: its `vertex_index`, `face_index` and `corner_index` lead to the mesh as given.

    Raises
    ------
    TopologyError
        if it is not a list of different inner vertices, if holes would meet each other or the boundary, and if the
        polygons of a vertex do not form a disk, because they also meet elsewhere.
    InvalidMesh
        if the surface is intrinsic.

    Cost: linear, but for a sort of the sides of the polygons that go.
    Source: Gu, Wang, Yau (2003), § 10: holes at fingertips.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> print(surface.boundary_count, holomorph.punch_holes(surface, [0, 500]).boundary_count)
    0 2
    """
    component = only_component(surface)
    if component._native.intrinsic:
        raise InvalidMesh("holes are punched into polygons, and this surface has edge lengths only")
    own, _ = own_vertices(surface, component, vertices, "hole")
    given, count = [int(v) for v in np.asarray(vertices)], len(component.vertices)
    if not given:
        return component
    hole_of_vertex = np.full(count, -1)
    hole_of_vertex[own] = np.arange(len(own))
    for hole in np.flatnonzero(hole_of_vertex[own] != np.arange(len(own))):
        raise TopologyError(f"hole {given[hole]} is named twice")
    sizes = np.diff(component.face_offsets)
    face, corners = np.repeat(np.arange(len(sizes)), sizes), np.asarray(component.corner_vertices)
    at_hole = hole_of_vertex[corners] >= 0
    first, last = _range(hole_of_vertex[corners[at_hole]], face[at_hole], len(sizes))
    _check_apart(first, last, given)
    goes = last[face] >= 0
    first, last = _range(last[face[goes]], corners[goes], count)
    _check_apart(first, last, given)
    for hole in np.setdiff1d(last[boundary_edges(component)], [-1]):
        raise TopologyError(f"hole {given[hole]} would meet the boundary")
    _check_disks(component, goes, last, given)
    return _without(component, goes, sizes[~goes[component.face_offsets[:-1]]])


def _range(holes, places, count):
    """The least and the largest of the holes at each place; -1 as the largest where there is none."""
    first, last = np.full(count, len(holes)), np.full(count, -1)
    np.minimum.at(first, places, holes)
    np.maximum.at(last, places, holes)
    return first, last


def _check_apart(first, last, given):
    for place in np.flatnonzero(first < last):
        raise TopologyError(f"holes {given[first[place]]} and {given[last[place]]} would meet")


def _check_disks(component, goes, hole_of_vertex, given):
    """#V - #E + #F is 1 for a disk; where its rim meets itself it is less, and 2 for all of a sphere."""
    count = len(hole_of_vertex)
    sides = np.unique(edge_keys(polygon_sides(component)[goes], count))
    starts = component.face_offsets[:-1]
    faces = component.corner_vertices[starts[goes[starts]]]
    vertices = np.flatnonzero(hole_of_vertex >= 0)
    numbers = [np.bincount(hole_of_vertex[at], minlength=len(given)) for at in (vertices, sides // count, faces)]
    for hole in np.flatnonzero(numbers[0] - numbers[1] + numbers[2] != 1):
        raise TopologyError(f"the faces around hole {given[hole]} do not form a disk: refine the mesh there")


def _without(component, goes, sizes):
    corners = np.ascontiguousarray(component.corner_vertices[~goes])
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    native = _native.Surface.from_polygons(component.vertices, corners, offsets)
    face_index = component.face_index[~goes[component.face_offsets[:-1]]]
    indices = component.vertex_index, face_index, component.corner_index[~goes]
    (part,) = Surface._of(native, Origin(*indices, component.given_vertex_count, up=component.up)).components
    return part


def cut_open(surface, is_seam):
    """Cuts the surface open along the edges of this mask, (#E,), but leaves no sliver without the neighbour at its
    longest side: no part is without area."""
    native, index = _native.cut_open(surface._native, is_seam)
    vertex_index = arrays.frozen(surface.vertex_index[index])
    origin = Origin(vertex_index, surface.face_index, surface.corner_index, surface.given_vertex_count, up=surface.up)
    return Surface._of(native, origin)
