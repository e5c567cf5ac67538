"""Disks with three vertices on their boundary and no room for a centre: too few corners for a rectangle."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import _native, arrays
from ._native import TopologyError
from .disk import DiskMap, PlaneMap
from .results import Residuals, SolverReport, result
from .truncated import truncated


@dataclass(frozen=True, eq=False)
class CoarseDiskMap(DiskMap):
    """`DiskMap` that was solved with the corners at its centre cut off, see `truncated`: then the centre has a star
    that does not touch the boundary. All vertices are vertices of that mesh too."""

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.disk_map().ravel()[: len(self._component.vertex_index)].copy())


@dataclass(frozen=True, eq=False)
class FlatTriangle(PlaneMap):
    """A single triangle, which is flat: its UVs are the triangle itself, with one side along u."""

    @property
    def description(self):
        """What was made, in one phrase."""
        return "a single triangle, laid flat"

    @cached_property
    def flip_count(self):
        """0: there is no edge to turn."""
        return 0

    @cached_property
    def _plane(self):
        p, q, r = self._component.vertices[self._component.triangles[0]]
        length = np.linalg.norm(q - p)
        along = (q - p) / length
        x = (r - p) @ along
        plane = np.zeros(3, complex)
        plane[self._component.triangles[0]] = 0, length, x + 1j * np.linalg.norm(r - p - x * along)
        return arrays.frozen(plane)

    def invariants(self):
        """None: all triangles are alike."""
        return {}


def coarse_disk(surface, component, solver, threads, progress):
    """`FlatTriangle` or `CoarseDiskMap`, its centre the vertex nearest to the middle of those inside.

    Raises TopologyError for an intrinsic surface.
    """
    if component.vertices is None:
        raise TopologyError("the disk has no room for a centre, and three edges on its boundary; subdivide the mesh")
    if len(component.triangles) == 1:
        report, exact = SolverReport("none", "a triangle is flat", 0, 0.0), Residuals(0.0, 0.0, 0.0)
        return FlatTriangle(surface, report, exact, {"total": 0.0}, None, component)
    inside = np.setdiff1d(component.triangles, _boundary_vertices(component))
    positions = component.vertices[inside]
    centre = int(inside[np.linalg.norm(positions - positions.mean(axis=0), axis=1).argmin()])
    (refined,) = truncated(component, [centre]).surface.components
    native = _native.punctured_structure(refined._native, [centre], [], [], solver, threads, progress)
    return result(CoarseDiskMap, surface, component, native)


def _boundary_vertices(component):
    triangles = component.triangles.astype(np.int64)
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    count = triangles.max() + 1
    return start[~np.isin(start * count + end, end * count + start)]
