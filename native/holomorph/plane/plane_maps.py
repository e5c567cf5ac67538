"""Maps of disks to the plane: to the unit disk, to a rectangle, to a triangle, and with a free boundary."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import plain
from ..forms.narrow_bounds import Refinement
from ..forms.results import SolverReport, Structure
from ..mesh.checks import checked_coefficients
from ..mesh.edges import boundary_corners
from ..quality.appearance import overlapping_part
from ..quality.quality import Quality


@dataclass(frozen=True, eq=False, repr=False)
class PlaneMap(Structure):
    """Base of the results for disks: one fixed map to the plane without a seam, with no forms to mix."""

    coefficient_type = np.complex128
    form_count = 0

    @cached_property
    def _core(self):
        return _native.plane_structure(self.map_kind, self._part, self._native, getattr(self, "modulus", 0.0))

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

    def balanced_coefficients(self, progress: Progress | None = None) -> Complexes:
        """(0,): the map is fixed."""
        return arrays.frozen(np.empty(0, dtype=np.complex128))

    def uv(self, coefficients: ArrayLike = ()) -> Reals:
        """(#C, 2) UVs, continuous everywhere; there are no coefficients."""
        checked_coefficients(coefficients, 0, np.complex128)
        z = self._plane[self._component.corner_vertices]
        return arrays.frozen(np.stack([z.real, z.imag], axis=1))


@dataclass(frozen=True, eq=False, repr=False)
class DiskMap(PlaneMap):
    """Result of `disk_map`: the Riemann map z = exp(2 pi i (u + iv)) of a disk to the unit disk, where u + iv has the
    residue 1 at the centre. z is 0 there and |z| = 1 on the boundary; a rotation is free."""

    map_kind = "disk"
    _core = Structure._core

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        return f"disk map, centre at vertex {self.centre}"

    @cached_property
    def centre(self) -> int:
        """The vertex that is mapped to 0."""
        return int(self._of_surface(self._native.poles())[0])

    @cached_property
    def _plane(self):
        return arrays.frozen(self._native.disk_map().ravel())

    def disk_map(self) -> Complexes:
        """(#V,) complex: |z| = 1 on the boundary, less inside (1 at most, where a mesh is very coarse), NaN at
        isolated vertices."""
        return self._at_vertices(self._plane)

    def invariants(self) -> dict[str, Any]:
        """The centre, as plain data: all disks are alike."""
        return {"centre": self.centre}


@dataclass(frozen=True, eq=False, repr=False)
class RectangleMap(PlaneMap):
    """Result of `rectangle_map`: the conformal map of a disk with four corners on its boundary to a rectangle.

    UVs have the width 1 and the height `modulus`, corner 0 at the origin, corner 1 at (1, 0); each of the four sides is
    straight, exactly.

    refinement : `Refinement` where narrower bounds were asked for, else None
    """

    map_kind = "rectangle"
    refinement: Refinement | None = None
    narrow_bounds: tuple[float, float] | None = None

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
        return self._native.modulus if self.narrow_bounds is None else float(np.sqrt(np.prod(self.narrow_bounds)))

    @property
    def modulus_bounds(self) -> tuple[float, float] | None:
        """(lower, upper): guaranteed bounds of the modulus of the polyhedral surface. None where degenerate triangles
        had to be mollified: another surface was solved on."""
        if self.narrow_bounds is not None:
            return self.narrow_bounds if self.refinement.has_bounds else None
        return (self._native.lower, self._native.upper) if self._is_exact else None

    @cached_property
    def collapsed_triangles(self) -> Integers:
        """(#,) triangles all of whose corners lie on one side: a map that makes the side straight collapses them."""
        return self._native.collapsed_triangles()

    @cached_property
    def _plane(self):
        points = self._native.points().ravel()
        return arrays.frozen(points.real + 1j * (points.imag * (self.modulus / self._native.modulus)))

    def invariants(self) -> dict[str, Any]:
        """The corners, and the modulus with its bounds, as plain data."""
        values = {"rectangle_corners": self.corners, "modulus": self.modulus, "modulus_bounds": self.modulus_bounds}
        return plain(values)


@dataclass(frozen=True, eq=False, repr=False)
class FreeBoundaryMap(PlaneMap):
    """Result of `free_boundary_map`: the conformal map of a disk with the least variation of density.

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
