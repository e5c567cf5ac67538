"""The conformal structure of a closed surface of genus >= 1, and everything that is read off it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import arrays
from .report import complex_pairs
from .results import ClosedResiduals, MemoryPlan, Structure, checked_coefficients


@dataclass(frozen=True, eq=False)
class ConformalStructure(Structure):
    """Result of `conformal_structure` for a closed surface of genus g >= 1."""

    residuals_kind = ClosedResiduals

    @property
    def description(self):
        """What was made, in one phrase."""
        g = self._periods.shape[1]
        return f"{g} holomorphic form{'s' if g > 1 else ''}"

    @cached_property
    def memory(self):
        """`MemoryPlan`: whether all forms are kept, and the memory that was reckoned with."""
        return MemoryPlan(*self._native.memory())

    @cached_property
    def homology_basis(self):
        """Tuple of 2g integer arrays: closed loops zeta_i of vertices, the first not repeated (paper § 4)."""
        return tuple(self._of_surface(loop) for loop in self._native.homology_basis())

    @cached_property
    def intersection_matrix(self):
        """(2g, 2g) integers zeta_i . zeta_j."""
        return self._native.intersection_matrix()

    @cached_property
    def canonical_basis(self):
        """(2g, 2g) integers, |det| 1: rows a_1..a_g, b_1..b_g written in the zeta."""
        return self._native.canonical_basis()

    @cached_property
    def harmonic_forms(self):
        """(2g, #E), dual to zeta: the integral of form i over zeta_j is delta_ij (paper § 6); see `prepare_uv`.
        Raises `SolverError` where they would take more than `memory_limit`, before they are made."""
        return self._native.harmonic_forms()

    @cached_property
    def holomorphic_forms(self):
        """(g, #E) complex: theta_j has the period 1 over a_j and 0 over the other a (paper § 7)."""
        g, edges = self._periods.shape[1], len(self.edges)
        # of the harmonic forms, and of two matrices of the size of the result
        self._native.require_memory(f"the {g} holomorphic forms on {edges} edges", 3 * 16 * g * edges)
        return arrays.frozen(self._periods.T @ self.harmonic_forms)

    @cached_property
    def gram_matrix(self):
        """(2g, 2g) L2 products of `harmonic_forms`, on the intrinsic triangulation."""
        return self._native.gram_matrix()

    @cached_property
    def period_matrix(self):
        """(g, g) complex Omega_ij, the integral of theta_j over b_i: symmetric, Im Omega > 0 (paper Eq. 13)."""
        return self._native.period_matrix()

    @cached_property
    def period_bounds(self):
        """(lower, upper), (g, g) each: guaranteed bounds of Im Omega of the polyhedral surface as quadratic forms."""
        return self._native.period_bounds()

    @cached_property
    def _periods(self):
        # (2g, g) complex: integral of theta_j over zeta_k
        return self._native.periods()

    def uv(self, coefficients):
        """(#C, 2) UVs of the form sum_j c_j theta_j, from g complex coefficients c. No solve: one small product;
        where the forms were not kept (`memory`), a solve for this map alone.

        Across every seam the UVs jump by a constant translation, without rotation or change of scale."""
        c = checked_coefficients(coefficients, self._periods.shape[1], np.complex128)
        return self._native.uv(self._periods @ c)

    def uv_of(self, n, m):
        """(#C, 2) with u = sum_j n_j h_j and v = sum_j m_j h_j, n and m of length 2g: seams jump by integers
        where n and m are integers."""
        n, m = np.asarray(n, dtype=np.float64), np.asarray(m, dtype=np.float64)
        if n.shape != (self._periods.shape[0],) or m.shape != n.shape or not np.isfinite([n, m]).all():
            count = self._periods.shape[0]
            raise ValueError(f"n and m have the shapes {n.shape} and {m.shape}; ({count},) finite numbers are needed")
        return self._native.uv(n + 1j * m)

    def balanced_coefficients(self):
        """(g,) complex coefficients of the combination whose texture density is most even (least variance of its
        logarithm over the surface's area), scaled so that the UV area of the surface is 1."""
        return self._balanced

    @cached_property
    def _balanced(self):
        return self._native.balanced_coefficients()

    def invariants(self):
        """The period matrix with its bounds, as plain data."""
        return {
            "conventions": "a_i.b_j = delta_ij; theta_j has period 1 over a_j; Omega_ij is its integral over b_i",
            "period_matrix": complex_pairs(self.period_matrix),
            "period_bounds": [bound.tolist() for bound in self.period_bounds],
        }
