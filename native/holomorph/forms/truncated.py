"""Log maps of meshes so coarse that the stars of any two vertices meet: cones, pyramids, tetrahedra."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import _native
from ..core import arrays
from ..mesh.edges import edge_keys, edges_of_keys
from ..mesh.surface import Surface
from .pole_structure import PoleStructure
from .results import result

CUT = 1 / 3  # part of each edge at a pole that is cut off: less than half, as both its ends may be poles
SAME_UV = 1e-9  # relative to the UV size: across an edge that is not a seam the UVs differ by rounding


@dataclass(frozen=True)
class Truncation:
    """The mesh with the corners at some of its vertices cut off and covered by triangles: the same surface, its
    polygons in their order, then one triangle for each corner that was cut off. Now these vertices have small stars."""

    surface: Surface
    first: np.ndarray  # (#C,) of each corner of the old mesh its corner in the new; two stand for one that was cut off
    cut: np.ndarray  # (k,) corners that were cut off, in the order of the triangles
    covers: np.ndarray  # (k, 3) their triangles' corners: towards the corner before, the vertex, towards the one after


def truncated(surface, vertices):
    """`Truncation` of a surface with positions at these vertices. O(#C)."""
    corners, offsets = surface.corner_vertices.astype(np.int64), surface.face_offsets.astype(np.int64)
    is_cut = np.isin(corners, vertices)
    cut = np.flatnonzero(is_cut)
    sizes = np.diff(offsets)
    after = np.arange(1, len(corners) + 1)
    after[offsets[1:] - 1] = offsets[:-1]
    before = np.empty_like(after)
    before[after] = np.arange(len(corners))
    # One new vertex on each edge that leaves one of the vertices, named by (vertex, other end).
    count = len(surface.vertices)
    here, there = np.tile(corners[cut], 2), corners[np.concatenate([before[cut], after[cut]])]
    names, place = np.unique(here * count + there, return_inverse=True)
    start, end = names // count, names % count
    positions = surface.vertices[start] + CUT * (surface.vertices[end] - surface.vertices[start])
    towards_before, towards_after = count + place.reshape(2, -1)

    first = np.cumsum(1 + is_cut) - (1 + is_cut)
    new_corners = np.empty(len(corners) + len(cut), np.int64)
    new_corners[first] = corners
    new_corners[first[cut]] = towards_before
    new_corners[first[cut] + 1] = towards_after
    covers = len(new_corners) + np.arange(3 * len(cut)).reshape(-1, 3)
    triangles = np.stack([towards_before, corners[cut], towards_after], axis=1)
    new_sizes = sizes + np.add.reduceat(is_cut.astype(np.int64), offsets[:-1])
    new_offsets = np.concatenate([[0], np.cumsum(np.concatenate([new_sizes, np.full(len(cut), 3)]))])
    refined = Surface.from_polygons(
        np.concatenate([surface.vertices, positions]), np.concatenate([new_corners, triangles.ravel()]), new_offsets
    )
    return Truncation(refined, first, cut, covers)


def far_corners(vertices):
    """The vertex farthest from the middle, and the one farthest from that; the first of equals."""
    p = int(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).argmax())
    return [p, int(np.linalg.norm(vertices - vertices[p], axis=1).argmax())]


def coarse_log_map(surface, component, solver, threads, progress):
    """`TruncatedStructure` of a closed surface of genus 0 with positions, its poles two far corners."""
    poles = far_corners(component.vertices)
    truncation = truncated(component, poles)
    (refined,) = truncation.surface.components
    native = _native.pole_structure(refined._native, poles, [], [], solver, threads, 0, progress)
    solved = result(PoleStructure, truncation.surface, refined, native, threads)
    own = solved.solver, solved.residuals, solved.timings, solved._solution, component, threads
    return TruncatedStructure(surface, *own, truncation, solved)


@dataclass(frozen=True, eq=False, repr=False)
class TruncatedStructure(PoleStructure):
    """`PoleStructure` of a mesh whose poles' stars meet. It was solved on its `Truncation`; UVs are those of
    the remaining corners, and the corners that were cut off are put back by a similarity."""

    _truncation: Truncation
    _refined: PoleStructure

    @cached_property
    def _triangulation(self):
        return self._component._native

    @cached_property
    def holomorphic_forms(self):
        """(1, #E) complex: theta_0, NaN on the edges that end at a pole."""
        z = self._complex_uv()
        values = np.full(len(self.edges), np.nan + 0j)
        tails, heads, keys = self._sides()
        values[keys] = z[heads] - z[tails]
        values[np.isin(self._component._native.edges, self._native.poles()).any(axis=1)] = np.nan
        return arrays.frozen(values[None])

    @cached_property
    def seams(self):
        """(#S,) indices into `edges` where the UVs of the two sides differ."""
        z = self._complex_uv()
        tails, heads, keys = self._sides()
        order = np.argsort(keys, kind="stable").reshape(-1, 2)
        ends = z[np.stack([tails, heads])][:, order]
        torn = np.abs(ends[..., 0] - ends[..., 1]).max(axis=0) > SAME_UV * np.abs(z - z[0]).max()
        return arrays.frozen(keys[order[torn, 0]].astype(np.int32))

    def _sides(self):
        """(tail corner, head corner, edge) of each side of each triangle, from the lower vertex to the higher."""
        triangles, corners = self._component.triangles, self._component.triangle_corners
        start, end = triangles.ravel().astype(np.int64), np.roll(triangles, -1, axis=1).ravel().astype(np.int64)
        tails, heads = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
        upwards = start < end
        edges = self._component._native.edges
        count = len(self._component.vertex_index)
        found = edges_of_keys(edges, edge_keys(np.stack([start, end], axis=1), count), count)
        return np.where(upwards, tails, heads), np.where(upwards, heads, tails), found

    def _complex_uv(self):
        return self.uv(self.balanced_coefficients()).view(np.complex128)[:, 0]

    def uv(self, coefficients):
        """(#C, 2) UVs of c_0 theta_0, from one complex coefficient."""
        refined = self._refined.uv(coefficients)
        z = np.ascontiguousarray(refined).view(np.complex128)[:, 0]
        first, cut, covers = self._truncation.first, self._truncation.cut, self._truncation.covers
        a, apex, b = z[covers].T
        result = z[first]
        start, end = z[first[cut]], z[first[cut] + 1]
        result[cut] = start + (apex - a) / (b - a) * (end - start)
        return result.view(np.float64).reshape(-1, 2)

    def sphere_map(self):
        """(#V, 3) points of the unit sphere; see `PoleStructure.sphere_map`."""
        count = len(self._component.vertex_index)
        return self._at_vertices(arrays.frozen(self._refined.sphere_map()[:count].copy()))
