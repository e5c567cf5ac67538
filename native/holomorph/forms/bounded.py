"""The conformal structure of a surface with boundary, and everything that is read off it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Bounds, Integers, Reals
from ..core.value import plain
from .certificate import certain_text
from .form_structure import CertifiedStructure
from .solver_report import BoundedResiduals


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
