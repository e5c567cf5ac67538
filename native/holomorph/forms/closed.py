"""The conformal structure of a closed surface of genus >= 1, and everything that is read off it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.array_types import Complexes, Integers, Reals
from ..core.value import plain
from .form_structure import CertifiedStructure
from .solver_report import ClosedResiduals


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
        values = {
            "conventions": "a_i.b_j = delta_ij; theta_j has period 1 over a_j; Omega_ij is its integral over b_i",
            "period_matrix": self.period_matrix,
            "period_bounds": self.period_bounds,
        }
        return plain(values)
