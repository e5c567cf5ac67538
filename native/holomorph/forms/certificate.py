"""What is proven about a result, and what was measured; period matrices that know their error."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_CEILING, Decimal, localcontext
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.array_types import Bounds
from ..core.value import Value

# Relative: rounding of `entry_bounds` in units of 2^-53, 1 of a mean, 4 of a radius, 3 of their sum and difference.
SLACK = 2.0**-50
OPEN = 1.0  # value of `Certificate.rounding` where the metric of a triangle is left open
ASYMMETRY = 1e-9  # of an entry, times the genus: a larger one is no error of rounding


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Value):
    """What is certain of the conformal invariants, and how far forms were from what they are on a smooth surface.

    Attributes
    ----------
    holds : whether the bounds are proven for the surface as it was given, whatever the solver did, rounding included
    reason : why they are not, one sentence; "" where they are
    imaginary_bounds : (lower, upper), (n, n) each: of Im Omega, as quadratic forms; None where there are none
    real_bounds : (lower, upper), (n, n) each: of the entries of Re Omega; None where there are none
    relative_width : the least x with upper - lower <= x Im Omega, as quadratic forms; NaN without bounds
    asymmetry : largest |R - R^T|, R = -G_ab (G_bb)^-1 the real part of Omega before the star is projected; NaN with
        boundary, where Omega is that of the double
    smallest_eigenvalue : of Im Omega
    star_defect : largest |C^2 + 1|, with boundary |C D + 1|, of the star before it is projected (spectral norm)
    closedness, co_closedness : `Residuals.closedness` and `harmonicity`
    period_error : largest difference of the periods of the harmonic forms from their integers
    rounding : largest relative change of the energy of a form on a triangle by the rounding of lengths; 1 if unknown
    """

    holds: bool
    reason: str
    imaginary_bounds: Bounds | None
    real_bounds: Bounds | None
    relative_width: float
    asymmetry: float
    smallest_eigenvalue: float
    star_defect: float
    closedness: float
    co_closedness: float
    period_error: float
    rounding: float

    def _facts(self):
        return [f"relative width {self.relative_width:.2g}", "the bounds hold" if self.holds else self.reason]

    def period_text(self) -> list[list[list[str]]] | None:
        """Omega as nested lists of [real, imaginary], each a text of value and uncertainty; None without bounds."""
        if self.imaginary_bounds is None:
            return None
        parts = [*self.real_bounds, *entry_bounds(*self.imaginary_bounds)]
        return [
            [[certain_text(a, b), certain_text(c, d)] for a, b, c, d in zip(*row, strict=True)]
            for row in zip(*parts, strict=True)
        ]

    def as_plain(self) -> dict[str, Any]:
        """Returns it as plain data, for reports."""
        plain = dict(vars(self)) | {"period_text": self.period_text()}
        for name in ("imaginary_bounds", "real_bounds"):
            bounds = plain[name]
            plain[name] = None if bounds is None else [bound.tolist() for bound in bounds]
        return plain


def certificate(structure):
    """`Certificate` of a `ConformalStructure` or `BoundedStructure`."""
    native = structure._native
    reason, rounding = why_uncertain(structure), native.metric_error()
    bounds = structure.period_bounds
    imaginary = structure.period_matrix.imag
    return Certificate(
        holds=not reason,
        reason=reason,
        imaginary_bounds=bounds,
        real_bounds=None if bounds is None else tuple(native.real_period_bounds()),
        relative_width=np.nan if bounds is None else relative_width(*bounds, imaginary),
        asymmetry=_asymmetry(native),
        smallest_eigenvalue=float(np.linalg.eigvalsh(imaginary)[0]),
        star_defect=_star_defect(native),
        closedness=structure.residuals.closedness,
        co_closedness=structure.residuals.harmonicity,
        period_error=structure.residuals.periods,
        rounding=rounding,
    )


def why_uncertain(structure):
    """One sentence, or "" where the bounds are proven for the surface as given."""
    mollification, rounding = structure._native.mollification(), structure._native.metric_error()
    if mollification:
        return f"degenerate triangles were lengthened by up to {mollification:.1e}: the solved surface differs slightly"
    if rounding >= OPEN:
        return "a triangle is so thin that rounding its sides leaves its shape uncertain"
    memory = getattr(structure, "memory", None)
    if memory is not None and not memory.keeps_forms:
        return "the forms were solved for in blocks, and their energies measured up to the solver's residual"
    return ""


def relative_width(lower, upper, value):
    """The least x with upper - lower <= x value, as quadratic forms."""
    root = np.linalg.inv(np.linalg.cholesky(value))
    return float(np.linalg.eigvalsh(root @ (upper - lower) @ root.T)[-1])


def _asymmetry(native):
    if len(native.gram_matrices()) > 1:
        return np.nan
    cycles = native.canonical_basis().astype(float)
    classes = np.linalg.inv(cycles).T
    gram = classes @ native.gram_matrices()[0] @ classes.T
    g = len(gram) // 2
    real = -gram[:g, g:] @ np.linalg.inv(gram[g:, g:])
    return float(np.abs(real - real.T).max())


def _star_defect(native):
    gram, pairing = native.gram_matrices(), native.pairing().astype(float)
    natural, dirichlet = gram[0], gram[-1]
    star = np.linalg.solve(pairing, natural).T  # C W^T = G_N
    other = -dirichlet @ np.linalg.inv(pairing)  # D = -G_D W^-1
    return float(np.linalg.norm(star @ other + np.eye(len(star)), 2))


def certain_text(lower, upper):
    """Value and uncertainty in certain digits alone, such as "2.178 +- 0.005": an interval that holds both bounds."""
    with localcontext() as context:
        context.prec = 800  # digits: enough for any double
        low, high = Decimal(float(lower)), Decimal(float(upper))
        if low == high:
            return f"{float(lower)!r}"
        unit = Decimal(1).scaleb((high - low).adjusted())
        shown = ((low + high) / 2).quantize(unit)
        error = max(high - shown, shown - low).quantize(unit, ROUND_CEILING)
        return f"{shown:f} +- {error:f}"


def entry_bounds(lower, upper):
    """(lower, upper) of each entry of a symmetric matrix between two quadratic forms: it misses their mean by at most
    (R_ii R_jj)^(1/2), R half their difference, by Cauchy and Schwarz."""
    half = np.diag(upper - lower) / 2 + SLACK * np.abs(np.diag(upper))
    middle, radius = (lower + upper) / 2, np.sqrt(np.outer(half, half)) * (1 + SLACK)
    return middle - radius - SLACK * np.abs(middle), middle + radius + SLACK * np.abs(middle)


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
