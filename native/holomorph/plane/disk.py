"""Maps of disks to the plane: to the unit disk, to a rectangle, and with a free boundary; and which one is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import plain
from ..forms.log_map import PoleStructure, pole_structure_of
from ..forms.narrow_bounds import Refinement, narrow
from ..forms.results import SolverReport, Structure, result
from ..mesh.checks import check_bounds, check_options, checked_coefficients, checked_uv, only_component, own_vertices
from ..mesh.edges import boundary_corners
from ..mesh.surface import Surface
from ..mesh.surgery import glued_copies
from ..quality.appearance import overlapping_part
from ..quality.quality import Quality
from ..tiling.request import part_of


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
        return replace(found, overlapping_part=overlapping_part((checked_uv(uv, self._component) @ [1, 1j])[border]))

    def invariants(self) -> dict[str, Any]:
        """Nothing: all disks are alike."""
        return {}


def disk_map(
    surface: Surface,
    centre: int | None = None,
    *,
    solver: str = "auto",
    threads: int | None = None,
    progress: Progress | None = None,
) -> DiskMap:
    """The `DiskMap` of a disk: its Riemann map to the unit disk.

    centre : vertex that is mapped to 0, its star apart from the boundary; default: the one farthest from the boundary
        along the edges
    solver, threads, progress : as in `conformal_structure`

    Raises TopologyError for other surfaces, and for a centre that does not fit; SolverError; Cancelled.
    Source: Riemann's mapping theorem by a differential with one pole; docs/method/disks.md.

    Examples
    --------
    >>> x, y = np.mgrid[0:9, 0:9]
    >>> corner = (9 * x + y)[:-1, :-1].ravel()
    >>> faces = np.stack([corner, corner + 9, corner + 10, corner + 1], axis=1)
    >>> sheet = holomorph.Surface(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), faces)
    >>> z = holomorph.disk_map(sheet, centre=40).disk_map()
    >>> print(abs(z[40]).round(3), abs(z[0]).round(3))
    0.0 1.0
    """
    count, component = check_options(solver, threads), _disk(surface, "a disk map")
    vertices, labels = own_vertices(surface, component, [] if centre is None else [centre], "centre")
    native = _native.pole_structure(component._native, vertices, [], labels, solver, count, 0, progress)
    made = result(DiskMap, surface, component, native, count)
    return made.computed_by(partial(disk_map, surface, centre, solver=solver, threads=threads))


def rectangle_map(
    surface: Surface,
    corners: Sequence[int] | Integers | None = None,
    *,
    solver: str = "auto",
    threads: int | None = None,
    bounds: float | None = None,
    most_faces: int = 2_000_000,
    progress: Progress | None = None,
) -> RectangleMap:
    """The `RectangleMap` of a disk with four corners on its boundary.

    corners : list of four boundary vertices in the order of the boundary, the surface on its left. Default: the clear
        corners of the boundary, where it turns by more than 45 degrees at exactly four places and back at none
        (native/src/flat/rectangle.h); else the quarters of its length
    bounds : relative width that the bounds of the modulus are to have, such as 1e-8; the result's `refinement` tells
    solver, threads, most_faces, progress : as in `conformal_structure`

    Raises TopologyError for other surfaces, for corners that do not fit, and for a boundary of three edges;
    SolverError; Cancelled.
    Source: the conjugate of a harmonic function with mixed conditions; docs/method/disks.md.

    Examples
    --------
    >>> square = holomorph.Surface([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> print(round(holomorph.rectangle_map(square, [0, 1, 2, 3]).modulus, 6))
    0.5
    """
    count, component = check_options(solver, threads), _disk(surface, "a rectangle")
    narrowing = check_bounds(bounds, most_faces)
    if corners is None:
        own = _native.clear_corners(component._native)
        vertices, labels = (_native.quarter_corners(component._native) if own is None else own), []
    else:
        vertices, labels = own_vertices(surface, component, corners, "rectangle corner")
    native = _native.rectangle_map(component._native, vertices, labels, solver, count, progress)
    given = None if corners is None else np.array(corners).tolist()  # the caller's list may change
    more = {} if narrowing is None else _narrowed(component._native, native, narrowing, count, progress)
    made = result(RectangleMap, surface, component, native, count, **more)
    again = {"solver": solver, "threads": threads, "bounds": bounds, "most_faces": most_faces}
    return made.computed_by(partial(rectangle_map, surface, given, **again))


def _narrowed(surface, rectangle, narrowing, threads, progress):
    """The `Refinement` of a native rectangle map, and narrower bounds of its modulus. Two copies glued along the sides
    0 and 2 are an annulus, whose circumference is twice the height: its modulus is that of 1 / (2 modulus)."""
    height = rectangle.points().ravel().imag
    start, end = height[surface.edges].T
    on_boundary = np.bincount(surface.triangle_edges.ravel(), minlength=len(start)) == 1
    # The sides 0 and 2 are straight, exactly.
    is_glued = on_boundary & (start == end) & np.isin(start, (0, rectangle.modulus))
    faces, lengths, names, _ = glued_copies(surface, is_glued)
    errors = np.tile(_native.length_errors(surface), 2)
    annulus = _native.refined_surface(int(faces.max()) + 1, faces, lengths, names, errors)
    native = _native.conformal_structure(annulus, False, "auto", threads, 0, progress)
    refinement = narrow(native, *narrowing, threads, 0, progress)
    low, high = native.inverse_gram_bounds()[1][0, 0], native.certain_gram_matrices()[0][0, 0]
    narrow_bounds = float(np.nextafter(0.5 / high, 0)), float(np.nextafter(0.5 / low, np.inf))
    return {"refinement": refinement, "narrow_bounds": narrow_bounds}


def free_boundary_map(
    surface: Surface, *, solver: str = "auto", threads: int | None = None, progress: Progress | None = None
) -> FreeBoundaryMap:
    """The `FreeBoundaryMap` of a disk, which keeps lengths along the boundary, with the least variation of density.

    solver, threads, progress : as in `conformal_structure`

    Raises TopologyError for other surfaces; SolverError; Cancelled.
    Source: Sawhney & Crane (2017), section 4, doi:10.1145/3132705.

    Examples
    --------
    >>> square = holomorph.Surface([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> flat = holomorph.free_boundary_map(square)
    >>> print(flat.scale_factors.round(6))
    [1. 1. 1. 1.]
    """
    count, component = check_options(solver, threads), only_component(surface)
    native = _native.free_boundary_map(component._native, solver, count, progress)
    made = result(FreeBoundaryMap, surface, component, native, count)
    return made.computed_by(partial(free_boundary_map, surface, solver=solver, threads=threads))


def _disk(surface, what):
    component = only_component(surface)
    if (component.genus, component.boundary_count) == (0, 1):
        return component
    raise TopologyError(f"the surface has {component._topology.text()}; {what} needs a disk")


KINDS = {"disk": DiskMap, "rectangle": RectangleMap, "flat": FreeBoundaryMap}


def default_disk_map(surface, *, solver, threads, progress) -> PlaneMap | PoleStructure:
    """The map of a disk for which nothing was chosen.

    Where its boundary has four clear corners, rough, round or wavy as they may be, the rectangle with these. Else the
    map to the unit disk centred at the vertex farthest from the boundary along the edges. Where its size range is
    above 10, as on a glove or a long tube, the most even one of it, the log map with the same pole and the
    rectangle with corners at the quarters of the boundary. Where every vertex is next to the boundary, that rectangle,
    or the map with a free boundary where the rectangle collapses triangles and it flips none, and with three boundary
    edges.
    """
    component, count = only_component(surface), check_options(solver, threads)
    options = {"solver": solver, "threads": count, "memory_limit": 0, "progress": progress}
    core = _native.automatic_structure(part_of(surface, component), **options)
    made = disk_structure_of(core, surface, component, count)
    return made.computed_by(partial(default_disk_map, surface, solver=solver, threads=threads, progress=None))


def disk_structure_of(core, surface, component, threads):
    """The `PlaneMap`, or log map, that the core made."""
    if core.kind == "log":
        return pole_structure_of(core, surface, component, threads)
    made = result(KINDS[core.kind], surface, component, core.plane_map or core.solved, threads)
    vars(made)["_core"] = core
    return made
