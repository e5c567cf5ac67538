"""Period matrices that know their error."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays

ASYMMETRY = 1e-9  # of an entry, times the genus: a larger one is no error of rounding


class PeriodMatrix(np.ndarray):
    """A (g, g) complex array, read-only, that knows how exact it is.

    error : bound of the distance to the exact matrix, in the metric of `Equivalence.residual`, which no change of the
        canonical basis changes. So it also holds for what is made of the array by such a change
    """

    error: float = 0.0

    @classmethod
    def of(cls, array: ArrayLike, error: float) -> PeriodMatrix:
        """The array, copied, with this error."""
        result = np.array(array, dtype=np.complex128).view(cls)
        result.error = float(error)
        return arrays.frozen(result)

    def __array_finalize__(self, source):
        self.error = getattr(source, "error", 0.0)

    def __reduce__(self):
        return PeriodMatrix.of, (np.asarray(self), self.error)


def distance_within(omega, change):
    """A bound of the distance to all matrices whose entries differ by `change` at most; infinite where one of them may
    be no period matrix."""
    if not (np.isfinite(change).all() and np.linalg.eigvalsh(omega.imag)[0] > 0):
        return np.inf
    inverse = np.abs(np.linalg.inv(np.linalg.cholesky(omega.imag)))
    # With Im Omega = L L^T, L^-1 E L^-T is the difference seen from i I: the distance is at most -log(1 - its norm).
    norm = np.linalg.norm(inverse @ change @ inverse.T)
    return -np.log1p(-norm) if norm < 1 else np.inf


def checked_period_matrix(given):
    """(g, g) complex, symmetric; ValueError for what cannot be one."""
    omega = arrays.complex_numbers(given, "the period matrix")
    g = omega.shape[0] if omega.ndim == 2 else 0
    if omega.shape != (g, g) or not g or not np.isfinite(omega).all() or np.abs(omega - omega.T).max() > ASYMMETRY * g:
        raise ValueError("a period matrix is square, symmetric and finite, such as [[0.3 + 1j]]")
    omega = (omega + omega.T) / 2
    if not (np.linalg.eigvalsh(omega.imag) > 0).all():
        raise ValueError("the imaginary part of a period matrix is positive definite")
    return omega
