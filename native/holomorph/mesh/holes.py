"""Small holes at chosen vertices: the paper punches them into the fingertips of a hand (Fig. 5)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import InvalidMesh, TopologyError
from .checks import only_component, own_vertices
from .edges import boundary_edges, edge_keys, polygon_sides
from .origin import Origin
from .surface import Surface


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
