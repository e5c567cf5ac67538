"""conformal_structure, and what it gives: forms and invariants of closed surfaces, and of surfaces with boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import SolverError, TopologyError
from ..core import arrays
from ..core.array_types import Bounds, Complexes, Integers, Progress, Reals
from ..core.value import plain
from ..mesh.checks import check_bounds, check_memory_limit, check_name, check_options, check_thresholds, only_component
from ..mesh.surface import Surface
from .certificate import certain_text
from .form_structure import CertifiedStructure
from .narrow_bounds import narrow
from .results import BoundedResiduals, ClosedResiduals, result

BOUNDARIES = ("natural", "double_cover")


def conformal_structure(
    surface: Surface,
    *,
    boundary: str = "natural",
    solver: str = "auto",
    thresholds: Sequence[float] | None = None,
    threads: int | None = None,
    memory_limit: float | None = None,
    bounds: float | None = None,
    most_faces: int = 2_000_000,
    progress: Progress | None = None,
) -> ConformalStructure | BoundedStructure:
    """Conformal structure of one connected surface with handles or at least two boundary loops: harmonic and
    holomorphic one-forms, and conformal invariants.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    boundary : how forms of a surface with boundary are found: "natural" on the surface itself, "double_cover" on its
        double, at twice the size, as the paper does (§ 8); the forms are the same to solver accuracy
    solver : "direct", a sparse Cholesky factorisation; "multigrid", in linear time and memory; "auto" chooses, the
        result's `solver` says what and why; "paper", its multiresolution algorithm (§ 9), slower, on the surface's own
        triangles, its edges not flipped, and with any `boundary` on the double of each level
    thresholds : numbers of faces at which the paper's solver refines the forms on its way from the base mesh to the
        surface; None for one at every factor of four in faces from about 500 on. With none of them, [], its conjugate
        gradients begin at zero on the surface itself: what the paper compares with
    threads : number of threads, None for one per core; the result has the same bits for any number
    memory_limit : bytes that may be in use at once, without the surface itself; None refuses nothing but thousands of
        forms on a small mesh, beyond 1 GB and 100 kB for each vertex. Where the forms of a closed surface do not fit
        (None: in 2 GB), they are solved for in blocks, and `uv` solves for each map
    bounds : relative width that the bounds of the period matrix (capacities, modulus) are to have, such as 1e-8. Forms
        are then solved for again by elements of higher order, on triangles that are cut smaller towards cone points
        where the bounds lose most, until they are as narrow, or `most_faces` or `memory_limit` (None: 8 GB) would be
        exceeded; the result's `refinement` tells. UVs and forms remain those of the surface's own triangles
    most_faces : number of triangles up to which `bounds` may refine
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns a ConformalStructure of a closed surface of genus >= 1, a BoundedStructure of one with boundary

    Raises TopologyError for several components, and for spheres and disks, which have no forms; SolverError if neither
    a residual of 1e-10 nor, among thin triangles, an error of 1e-6 in energy is reached, or rounding leaves no digit of
    the invariants, or memory runs out, or `memory_limit` does not hold two right-hand sides (names the bytes that
    would); Cancelled.

    Cost: 2n solves of the Laplacian for n complex forms (n = g closed, 2g + b - 1 with boundary), after one
    factorisation or the set-up of multigrid; 2 n #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 8 and Eq. 13; the star by Gu & Yau (2003), projected.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(structure.period_matrix.shape, structure.certificate.holds)
    (3, 3) True
    """
    count, narrowing = check_options(solver, threads), check_bounds(bounds, most_faces)
    check_name(boundary, BOUNDARIES, "boundary")
    limit, component = check_memory_limit(memory_limit), only_component(surface)
    _check_topology(component)
    options = solver, count, limit, progress
    native = _native_structure(component, boundary, check_thresholds(thresholds, solver), *options)
    kind = BoundedStructure if component.boundary_count else ConformalStructure
    more = {} if narrowing is None else {"refinement": _narrowed(native, narrowing, count, limit, progress)}
    again = {"boundary": boundary, "solver": solver, "thresholds": thresholds}
    again |= {"threads": threads, "memory_limit": memory_limit}
    made = result(kind, surface, component, native, count, **more)
    return made.computed_by(partial(conformal_structure, surface, bounds=bounds, most_faces=most_faces, **again))


def _check_topology(component):
    topology = component.genus, component.boundary_count
    if topology == (0, 0):
        raise TopologyError("a closed surface of genus 0 has no holomorphic forms; log_map gives its differential")
    if topology == (0, 1):
        maps = "disk_map, rectangle_map and free_boundary_map"
        raise TopologyError(f"a disk has no holomorphic forms; {maps} give maps of it")


def _native_structure(component, boundary, thresholds, solver, threads, memory_limit, progress):
    if solver == "paper":
        return _native.paper_structure(component._native, thresholds, threads, memory_limit, progress)
    is_double = component.boundary_count > 0 and boundary == "double_cover"
    return _native.conformal_structure(component._native, is_double, solver, threads, memory_limit, progress)


def _narrowed(native, narrowing, threads, memory_limit, progress):
    """The `Refinement`; the bounds of `native` become narrower."""
    if not native.memory().keeps_forms:
        raise SolverError("narrowing the bounds needs all forms in memory; these were solved for in blocks")
    return narrow(native, *narrowing, threads, memory_limit, progress)


@dataclass(frozen=True, eq=False, repr=False)
class ConformalStructure(CertifiedStructure):
    """Result of `conformal_structure` for a closed surface of genus g >= 1: 2g harmonic and g holomorphic forms."""

    map_kind = "forms"
    residuals_kind = ClosedResiduals

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        g = self._differentials.shape[1]
        return f"{g} holomorphic form{'s' if g > 1 else ''}"

    @cached_property
    def intersection_matrix(self) -> Integers:
        """(2g, 2g) integers zeta_i . zeta_j."""
        return self._native.intersection_matrix()

    @cached_property
    def canonical_basis(self) -> Integers:
        """(2g, 2g) integers, |det| 1: rows a_1..a_g, b_1..b_g written in the zeta."""
        return self._native.canonical_basis()

    @property
    def harmonic_forms(self) -> Reals:
        """(2g, #E), dual to zeta: the integral of form i over zeta_j is delta_ij (paper § 6); see `prepare_uv`.

        Harmonic on the triangles of the surface, where `gram_matrix` is of the intrinsic ones. If no form's energy
        on the surface's triangles exceeds the one there by more than 1e-9 of it, the functions found there are taken:
        then each form is the harmonic one to 3e-5 of its norm, and `uv_solver` is `solver`.
        Raises `SolverError` where they would take more than `memory_limit`, before they are made."""
        return self._harmonic_forms

    @cached_property
    def gram_matrix(self) -> Reals:
        """(2g, 2g) L2 products of `harmonic_forms`, on the intrinsic triangulation."""
        return self._native.gram_matrices()[0]

    @cached_property
    def paper_period_matrix(self) -> Complexes:
        """(2g, 2g) complex P, the integral of `h_j + i *h_j` over zeta_i (paper Eq. 13): 1 + i S. As the star here is
        closed, it does not depend on how the loops run, and S^2 = -1 to rounding. The columns span the g holomorphic
        forms' periods, of which `period_matrix` has the normalised part."""
        return arrays.frozen(np.eye(len(self.gram_matrix)) + 1j * self._native.star().T)

    def uv_of(self, n: ArrayLike, m: ArrayLike) -> Reals:
        """(#C, 2) with u = sum_j n_j h_j and v = sum_j m_j h_j, n and m of length 2g: seams jump by integers
        where n and m are integers."""
        n, m = arrays.numbers(n, "n"), arrays.numbers(m, "m")
        count = self._differentials.shape[0]
        if n.shape != (count,) or m.shape != n.shape or not np.isfinite([n, m]).all():
            raise ValueError(f"n and m have the shapes {n.shape} and {m.shape}; ({count},) finite numbers are needed")
        return self._native.uv(n + 1j * m)

    def invariants(self) -> dict[str, Any]:
        """The period matrix with its bounds, as plain data."""
        conventions = "a_i.b_j = delta_ij; theta_j has period 1 over a_j; Omega_ij is its integral over b_i"
        bounds = {"period_matrix": self.period_matrix, "period_bounds": self.period_bounds}
        return plain({"conventions": conventions, **bounds})


@dataclass(frozen=True, eq=False, repr=False)
class BoundedStructure(CertifiedStructure):
    """Result of `conformal_structure` for a surface of genus g with b >= 1 boundary loops. n = 2g + b - 1 >= 1 is the
    genus of its double (paper § 8).

    Two families of n harmonic forms: the natural ones, in which nothing is fixed, and the Dirichlet ones, which vanish
    along the boundary. The star exchanges them: theta_i = h^N_i + i sum_j C#_ij h^D_j is holomorphic, and the imaginary
    part of every real combination is constant along each boundary loop, which becomes a straight line.
    """

    residuals_kind = BoundedResiduals
    coefficient_type = np.float64

    @property
    def map_kind(self) -> str:
        """A strip is one that its other sides close up."""
        return "strip" if (self._component.genus, self._component.boundary_count) == (0, 2) else "forms"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        n = len(self.pairing)
        return "1 form, straight boundaries" if n == 1 else f"{n} forms, straight boundaries"

    @cached_property
    def boundary_loops(self) -> tuple[Integers, ...]:
        """Tuple of b integer arrays of vertices, the hole on the left. Loop 0 is the longest; the others follow by
        their lowest vertex, at which each loop starts. Levels of a progressive mesh have the order of its base."""
        return tuple(self._of_surface(loop) for loop in self._native.boundary_loops())

    @cached_property
    def pairing(self) -> Integers:
        """(n, n) integers W_ij, the integral of h^N_i ^ h^D_j: [[J_h, 0], [X, 1]], |det| 1; the first 2g classes are
        those of the handles, the others those of the loops."""
        return self._native.pairing()

    @cached_property
    def natural_forms(self) -> Reals:
        """(n, #E), dual to `homology_basis`: harmonic, with free boundary; see `prepare_uv`."""
        return arrays.frozen(self._harmonic_forms[: len(self.pairing)])

    @cached_property
    def dirichlet_forms(self) -> Reals:
        """(n, #E): harmonic, zero on all boundary edges. The first 2g are of the classes of the handles; the others are
        d of the harmonic functions that are 1 on one of the loops 1 .. b-1 and 0 on the others."""
        return arrays.frozen(self._harmonic_forms[len(self.pairing) :])

    @cached_property
    def gram_matrices(self) -> tuple[Reals, Reals]:
        """(natural, Dirichlet), (n, n) each: L2 products of the forms, on the intrinsic triangulation."""
        return tuple(self._native.gram_matrices())

    @cached_property
    def projected_gram_matrices(self) -> tuple[Reals, Reals]:
        """(natural, Dirichlet), (n, n) each: G_N# = G_N # (W G_D^-1 W^T), the geometric mean, and W^T (G_N#)^-1 W. They
        lie between the bounds W G_D^-1 W^T <= G_N and W^T G_N^-1 W <= G_D of the polyhedral surface."""
        return self._native.natural_gram(), self._native.dirichlet_gram()

    @cached_property
    def star(self) -> Reals:
        """(n, n) C#: the conjugate of h^N_i is sum_j C#_ij h^D_j; that of h^D_j is -sum_i (C#^-1)_ji h^N_i."""
        return self._native.star()

    @cached_property
    def collapsed_triangles(self) -> Integers:
        """(#,) triangles all of whose corners lie on one boundary loop: a map that makes the loop straight gives them
        no area."""
        return self._native.collapsed_triangles()

    # ---- planar surfaces -------------------------------------------------------------------------

    @property
    def capacity_matrix(self) -> Reals:
        """(b-1, b-1) of a planar surface, genus 0: the energy of the harmonic functions that are 1 on one of the loops
        1 .. b-1 and 0 on the others. It does not change under conformal maps.

        Raises
        ------
        TopologyError
            on a surface with handles.
        """
        self._check_planar("capacity matrix")
        return self.projected_gram_matrices[1]

    @property
    def capacity_bounds(self) -> Bounds | None:
        """(lower, upper), (b-1, b-1) each: guaranteed bounds of the polyhedral surface's `capacity_matrix`, as
        quadratic forms; None where those of `period_bounds` are."""
        self._check_planar("capacity matrix")
        return self._capacity_bounds

    @cached_property
    def _capacity_bounds(self):
        if not self._is_exact:
            return None
        return self._native.inverse_gram_bounds()[0], self._native.certain_gram_matrices()[1]

    @property
    def modulus(self) -> float:
        """The modulus of an annulus (genus 0, two loops): height over circumference of the conformal cylinder. It is
        ln(R/r) / 2 pi for a round ring; the inverse of the capacity.

        Raises
        ------
        TopologyError
            on any other surface.
        """
        self._check_annulus()
        return float(self.projected_gram_matrices[0][0, 0])

    @property
    def modulus_bounds(self) -> tuple[float, float] | None:
        """(lower, upper): guaranteed bounds of the polyhedral annulus's `modulus`; None where those of
        `period_bounds` are."""
        self._check_annulus()
        if not self._is_exact:
            return None
        return float(self._native.inverse_gram_bounds()[1][0, 0]), float(self._native.certain_gram_matrices()[0][0, 0])

    def _check_planar(self, what):
        genus = self._component.genus
        if genus:
            raise TopologyError(f"only planar surfaces have a {what}; the surface has genus {genus}")

    def _check_annulus(self):
        component = self._component
        if (component.genus, component.boundary_count) != (0, 2):
            found = component._topology.text()
            raise TopologyError(f"only annuli have a modulus; the surface has {found}")

    def invariants(self) -> dict[str, Any]:
        """Period matrix of the double, capacities and modulus with their bounds, as plain data."""
        surface = self._component
        values = {
            "conventions": "Omega is the period matrix of the double, a_i.b_j = delta_ij; loop 0 is the longest",
            "period_matrix": self.period_matrix,
            "period_bounds": self.period_bounds,
            "collapsed_triangles": len(self.collapsed_triangles),
        }
        if surface.genus == 0:
            values["capacity_matrix"] = self.capacity_matrix
            values["capacity_bounds"] = self.capacity_bounds
        if (surface.genus, surface.boundary_count) == (0, 2):
            values["modulus"], values["modulus_bounds"] = self.modulus, self.modulus_bounds
            values["modulus_text"] = None if self.modulus_bounds is None else certain_text(*self.modulus_bounds)
        return plain(values)
