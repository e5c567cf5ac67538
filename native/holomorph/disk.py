"""Disks: maps to the unit disk and to a rectangle, that with a free boundary, and which is taken without a choice."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native, arrays
from ._native import TopologyError
from .array_types import Complexes, Integers, Progress, Reals
from .checks import checked_coefficients, own_vertices
from .edges import boundary_corners
from .overlap import overlapping_part
from .plain_data import plain
from .punctured import PuncturedStructure
from .quality import Quality
from .results import SolverReport, Structure, result

UNEVEN = 100.0  # density ratio of a disk map, ten in length, above which others are tried


@dataclass(frozen=True, eq=False, repr=False)
class PlaneMap(Structure):
    """Base of the results for disks: one fixed map to the plane without a seam, with no forms to mix."""

    @cached_property
    def seams(self) -> Integers:
        """(0,): the map is continuous."""
        return arrays.frozen(np.empty(0, dtype=np.int32))

    @cached_property
    def holomorphic_forms(self) -> Complexes:
        """(0, #E): there are no forms on a disk, and none to mix."""
        return arrays.frozen(np.empty((0, len(self.edges)), dtype=np.complex128))

    def prepare_uv(self, progress: Progress | None = None) -> None:
        """Nothing is left to do: the map is that of the surface's own triangles."""

    @property
    def uv_solver(self) -> SolverReport:
        """The same as `solver`."""
        return self.solver

    def balanced_coefficients(self) -> Complexes:
        """(0,): the map is fixed."""
        return arrays.frozen(np.empty(0, dtype=np.complex128))

    def uv(self, coefficients: ArrayLike = ()) -> Reals:
        """(#C, 2) UVs, continuous everywhere; there are no coefficients."""
        checked_coefficients(coefficients, 0, np.complex128)
        z = self._plane[self._component.corner_vertices]
        return arrays.frozen(np.stack([z.real, z.imag], axis=1))


@dataclass(frozen=True, eq=False, repr=False)
class DiskMap(PlaneMap):
    """Result of `conformal_structure` for a disk with a puncture: its Riemann map z = exp(2 pi i (u + iv)) to the unit
    disk, where u + iv has the residue 1 at the puncture. z is 0 there and |z| = 1 on the boundary; a rotation is
    free."""

    map_kind = "disk"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        return f"disk map, centre at vertex {self.punctures[0]}"

    @cached_property
    def punctures(self) -> Integers:
        """(1,): the vertex that is mapped to 0."""
        return self._of_surface(self._native.punctures())

    @cached_property
    def residues(self) -> Complexes:
        """(1,): 1."""
        return self._native.residues()

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.disk_map().ravel())

    def disk_map(self) -> Complexes:
        """(#V,) complex: |z| = 1 on the boundary, less inside (1 at most, where a mesh is very coarse), NaN at
        isolated vertices."""
        return self._at_vertices(self._plane)

    def invariants(self) -> dict[str, Any]:
        """The centre, as plain data: all disks are alike."""
        return plain({"punctures": self.punctures})


@dataclass(frozen=True, eq=False, repr=False)
class RectangleMap(PlaneMap):
    """Result of `conformal_structure` for a disk with four corners on its boundary: the conformal map to a rectangle.

    UVs have the width 1 and the height `modulus`, corner 0 at the origin, corner 1 at (1, 0); each of the four sides is
    straight, exactly."""

    map_kind = "rectangle"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        names = [str(corner) for corner in self.corners]
        text = f"rectangle with corners {', '.join(names[:-1])} and {names[-1]}"
        count = len(self.collapsed_triangles)
        if count == 0:
            return text
        return f"{text}; {count} triangle{'s' if count > 1 else ''} along one side collapsed"

    @cached_property
    def corners(self) -> Integers:
        """(4,) vertices, in the order of the boundary, the surface on its left."""
        return self._of_surface(self._native.corners())

    @property
    def modulus(self) -> float:
        """Height over width, between `modulus_bounds`: a conformal invariant of the surface with its four corners."""
        return self._native.modulus()[0]

    @property
    def modulus_bounds(self) -> tuple[float, float] | None:
        """(lower, upper): guaranteed bounds of the modulus of the polyhedral surface. None where degenerate triangles
        had to be mollified: another surface was solved on."""
        return self._native.modulus()[1:] if self._is_exact else None

    @cached_property
    def collapsed_triangles(self) -> Integers:
        """(#,) triangles all of whose corners lie on one side: a map that makes the side straight collapses them."""
        return self._native.collapsed_triangles()

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.points().ravel())

    def invariants(self) -> dict[str, Any]:
        """The corners, and the modulus with its bounds, as plain data."""
        values = {"rectangle_corners": self.corners, "modulus": self.modulus, "modulus_bounds": self.modulus_bounds}
        return plain(values)


@dataclass(frozen=True, eq=False, repr=False)
class TriangleMap(PlaneMap):
    """Result of `conformal_structure` for a disk with three boundary edges and no vertex for a centre, such as a single
    triangle: the harmonic map to the triangle with these edges, its longest side 1."""

    map_kind = "triangle"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        return "triangle with the sides of the boundary"

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.points().ravel())

    def invariants(self) -> dict[str, Any]:
        """Nothing: all disks are alike."""
        return {}


@dataclass(frozen=True, eq=False, repr=False)
class FreeBoundaryMap(PlaneMap):
    """Result of `conformal_structure` for a disk with a free boundary: the conformal map of least variation of density.

    Lengths are kept along the boundary: the scale factors e^u are 1 there, and of all conformal maps this one has the
    least Dirichlet energy of u (Sawhney and Crane 2017). A flat surface is mapped by a rigid motion. Around much
    curvature the map may overlap itself: `quality(uv).overlapping_part` says how much."""

    map_kind = "flat"

    @property
    def description(self) -> str:
        """What was made, in one phrase."""
        return "free boundary, its lengths kept"

    @cached_property
    def scale_factors(self) -> Reals:
        """(#V,) e^u, length in the plane over length on the surface: 1 on the boundary, NaN at isolated vertices."""
        return self._at_vertices(arrays.frozen(self._native.scale_factors().ravel()))

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.points().ravel())

    def quality(self, uv: ArrayLike) -> Quality:
        """`Quality` of a (#C, 2) UV map that is continuous, also of how much it covers itself."""
        found = super().quality(uv)
        border = boundary_corners(self._component)
        return replace(found, overlapping_part=overlapping_part((self._checked_uv(uv) @ [1, 1j])[border]))

    def invariants(self) -> dict[str, Any]:
        """Nothing: all disks are alike."""
        return {}


def automatic_disk_map(surface, component, solver, threads, progress):
    """The map of a disk for which nothing was chosen.

    Where its boundary has four clear corners, rough, round or wavy as they may be, the rectangle with these: where it
    turns by more than 45 degrees at exactly four places, and back at none (plane/clear_corners.h). Else the map to the
    unit disk centred at the vertex farthest from the boundary along the edges. Where its density ratio is above
    `UNEVEN`, as on a glove or a long tube, the most even one of it, the log map with the same puncture and the
    rectangle with corners at the quarters of the boundary. Where every vertex is next to the boundary, that rectangle,
    or the map with a free boundary where the rectangle collapses triangles and it flips none; with three boundary edges
    a triangle.
    """
    options = solver, threads, progress
    corners = _native.clear_corners(component._native)
    if corners is not None:
        return _rectangle(surface, component, corners, [], *options)
    try:
        round_map = disk(surface, component, [], [], *options)
    except TopologyError:
        if _native.boundary_length(component._native) == 3:
            return result(TriangleMap, surface, component, _native.triangle_map(component._native, *options), threads)
        return _without_inner_vertices(surface, component, options)
    if _density_ratio(round_map) <= UNEVEN:
        return round_map
    maps = [round_map, result(PuncturedStructure, surface, component, round_map._native, threads)]
    if _native.boundary_length(component._native) > 3:
        maps.append(_rectangle(surface, component, _native.quarter_corners(component._native), [], *options))
    return min(maps, key=_density_ratio)


def _without_inner_vertices(surface, component, options):
    """A rectangle whose sides take no whole triangle, or what keeps its shape."""
    straight = _rectangle(surface, component, _native.quarter_corners(component._native), [], *options)
    if not len(straight.collapsed_triangles):
        return straight
    free = free_boundary(surface, component, *options)
    return straight if free.quality(free.uv()).flipped.any() else free


def _density_ratio(structure):
    return structure.quality(structure.uv(structure.balanced_coefficients())).density_ratio


def _rectangle(surface, component, corners, labels, solver, threads, progress):
    native = _native.rectangle_map(component._native, corners, labels, solver, threads, progress)
    return result(RectangleMap, surface, component, native, threads)


def rectangle(surface, component, chosen, solver, threads, progress):
    """`RectangleMap` of a disk with the chosen corners."""
    corners, labels = own_vertices(surface, component, chosen, "rectangle corner")
    return _rectangle(surface, component, corners, labels, solver, threads, progress)


def free_boundary(surface, component, solver, threads, progress):
    """`FreeBoundaryMap` of a disk."""
    native = _native.free_boundary_map(component._native, solver, threads, progress)
    return result(FreeBoundaryMap, surface, component, native, threads)


def disk(surface, component, punctures, labels, solver, threads, progress):
    """`DiskMap` of a disk with its one puncture."""
    native = _native.punctured_structure(component._native, punctures, [], labels, solver, threads, 0, progress)
    return result(DiskMap, surface, component, native, threads)
