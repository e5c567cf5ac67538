"""Period matrices reduced by Sp(2g, Z): tidy to print, not unique for genus >= 2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Integers
from ..core.value import Value
from ..forms.period_matrix import PeriodMatrix, checked_period_matrix

CONVENTION = (
    "Im Omega is reduced (LLL, 0.99), |Re Omega| <= 1/2, |Omega_11| >= 1; for genus 1 that is the fundamental domain "
    "of SL(2, Z), on its edge Re tau >= 0"
)
ROUNDING = 1e-9  # a number within it of the edge of the domain is on it, so that the reduction ends
MOST_STEPS = 1000


@dataclass(frozen=True, eq=False, repr=False)
class SiegelReduction(Value):
    """period_matrix : (g, g) `PeriodMatrix` (A Omega + B)(C Omega + D)^-1, as exact as the one given; matrix : (2g, 2g)
    integers [[A, B], [C, D]], symplectic; convention : the conditions that it fulfils, in words."""

    period_matrix: PeriodMatrix
    matrix: Integers
    convention: str = CONVENTION

    def _facts(self):
        return [f"genus {len(self.period_matrix)}", f"Omega_11 {complex(self.period_matrix[0, 0]):.6g}"]


def siegel_reduction(period_matrix: ArrayLike) -> SiegelReduction:
    """A `SiegelReduction` of a period matrix: symmetric, its imaginary part positive definite.

    Source: Deconinck, Heil, Bobenko, van Hoeij & Schmies (2004), doi:10.1090/S0025-5718-03-01609-0.

    Raises ValueError for a matrix that is none of periods, or too badly conditioned to be reduced.

    Examples
    --------
    >>> print(holomorph.siegel_reduction([[3.2 + 1.1j]]).period_matrix)
    [[0.2+1.1j]]
    """
    omega, error = checked_period_matrix(period_matrix), getattr(period_matrix, "error", 0.0)
    g = len(omega)
    matrix, one, none = np.eye(2 * g, dtype=np.int64), np.eye(g, dtype=np.int64), np.zeros((g, g), np.int64)
    for _ in range(MOST_STEPS):
        rows = _native.short_basis(omega.imag)
        omega = rows @ omega @ rows.T
        inverse = np.rint(np.linalg.inv(rows)).astype(np.int64)
        shift = _nearest(omega.real)
        omega = omega - shift
        matrix = np.block([[one, -shift], [none, one]]) @ np.block([[rows, none], [none, inverse.T]]) @ matrix
        if abs(omega[0, 0]) >= 1 - ROUNDING:
            omega, matrix = _on_the_edge(omega, matrix)
            return SiegelReduction(PeriodMatrix.of(omega, error), arrays.frozen(matrix))
        inversion = _inversion(g)
        omega, matrix = moved(omega, inversion), inversion @ matrix
    raise ValueError("the period matrix is too badly conditioned to be reduced")


def moved(omega, matrix):
    """(A Omega + B)(C Omega + D)^-1, symmetric."""
    g = len(omega)
    a, b, c, d = matrix[:g, :g], matrix[:g, g:], matrix[g:, :g], matrix[g:, g:]
    result = np.linalg.solve((c @ omega + d).T, (a @ omega + b).T).T
    return (result + result.T) / 2


def _nearest(real):
    """Integers S = S^T with |real - S| <= 1/2; of 1/2 itself, to rounding, it takes none."""
    return np.where(np.abs(real) <= 0.5 + ROUNDING, 0, np.rint(real)).astype(np.int64)


def _inversion(g):
    """Omega_11 -> -1 / Omega_11."""
    first = np.zeros((g, g), np.int64)
    first[0, 0] = 1
    rest = np.eye(g, dtype=np.int64) - first
    return np.block([[rest, -first], [first, rest]])


def _on_the_edge(omega, matrix):
    """On the edge of the domain of genus 1, takes the half with Re tau >= 0."""
    if len(omega) > 1:
        return omega, matrix
    if omega[0, 0].real <= -0.5 + ROUNDING:
        step = np.array([[1, 1], [0, 1]])
    elif omega[0, 0].real < -ROUNDING and abs(omega[0, 0]) <= 1 + ROUNDING:
        step = np.array([[0, -1], [1, 0]])
    else:
        return omega, matrix
    return moved(omega, step), step @ matrix
