"""Igusa's invariants of surfaces of genus 2, with intervals, from theta constants."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import combinations, product

import numpy as np

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Progress, Reals
from ..core.value import Value
from ..forms.closed import ConformalStructure
from ..forms.narrow_bounds import Refinement
from ..forms.results import Structure
from ..forms.structure import conformal_structure
from ..mesh.checks import check_type, real_number
from .known_periods import period_lattice
from .siegel import siegel_reduction

PARTS = 2.0 ** -np.arange(1, 7)
ORDER = 8  # of the Taylor series, and values along each circle
INNER, OUTER = 1 / 16, 1 / 2  # radii of polydisks, in a ball of radius 1: [[a, b], [b, c]] has twice the norm of |a|
SPARE = 0.8  # of the width of the bounds that seems to be enough: it is not the same in all directions
MOST_FINER = 10.0  # times narrower at a step to them
SMALLEST_TERM = 40.0  # terms below exp(-this) are left out of a theta series
ROUNDING = 1e-12  # relative: more than that of a term, its exponent below SMALLEST_TERM, and of a reduced period matrix
UNIT = 2.0**-50  # relative, of one operation on complex numbers and of the error's own
MOST_ROUNDS = 4  # of refinement, each narrower
SMALL = 1.0  # invariants below it are to be known to `width` itself, not to a part of them


@dataclass(frozen=True, eq=False, repr=False)
class IgusaInvariants(Value):
    """Three numbers that tell a surface of genus 2, the curve y^2 = f(x), f of degree 5 or 6: I2^5 / I10, I2^3 I4 / I10
    and I2^2 I6 / I10, of the invariants I2, I4, I6, I10 of f by Igusa and Clebsch. I10 is the discriminant, and the
    others are sums over products of differences of the roots. Two surfaces with I2 other than 0 are conformally
    equivalent if and only if all three agree.

    values : (3,) complex, in this order
    errors : (3,) the exact ones of the polyhedral surface are certainly within these distances (where the certificate's
        bounds hold); infinite where the bounds of the periods allow I10 = 0
    refinement : how the bounds were narrowed to the `width` asked for, and what kept them from it; None without one
    """

    values: Complexes
    errors: Reals
    refinement: Refinement | None = None

    def _facts(self):
        # Two digits change the error by 5 % at most: what is printed is not below it.
        return [f"{complex(value):.6g} +- {1.06 * error:.2g}" for value, error in zip(self.values, self.errors)]


def igusa_invariants(
    structure: ConformalStructure,
    *,
    width: float | None = None,
    most_faces: int = 2_000_000,
    progress: Progress | None = None,
) -> IgusaInvariants:
    """The `IgusaInvariants` of a closed structure of genus 2. Those of the mirror image are the conjugate numbers.

    Errors are as large as the bounds of the periods leave them, within a factor of about 2. Where handles are far from
    each other, I10 near 0, they are some hundred times as wide as these bounds, relative to the values.

    Parameters
    ----------
    width : errors that are asked for, in parts of the values, of 1 where these are smaller: 0.01 for 1 %. Bounds are
        narrowed by refinement, as by `bounds` of `conformal_structure`, until they are reached; None leaves them
    most_faces : number of triangles up to which that may refine
    progress : progress(fraction, stage), as in `conformal_structure`

    Raises TopologyError for other surfaces; ValueError for a width that is not positive; Cancelled.

    Cost: some milliseconds; with a width that of `conformal_structure` with bounds, once to four times.
    Source: Streng (2014), doi:10.1090/S0025-5718-2013-02712-3, § 7: theta constants, with the invariants' definition by
    Igusa (1960).

    Examples
    --------
    >>> side = 2 * np.sin(np.pi / 8)  # of a regular octagon, whose opposite sides are glued
    >>> edges = [(i % 4, 4 + (i + 1) % 8, 4 + i) for i in range(8)]
    >>> octagon = holomorph.Surface.from_edge_lengths([(1, 0, 0)] * 8, [(side, 1, 1)] * 8, edges)
    >>> structure = holomorph.conformal_structure(octagon, bounds=1e-2)
    >>> print(holomorph.igusa_invariants(structure).values.real.round())  # as of y^2 = x^5 - x
    [400000. -20000.  -2000.]
    """
    check_type(structure, Structure, "structure")
    if not isinstance(structure, ConformalStructure) or structure._component.genus != 2:
        raise TopologyError("Igusa's invariants need a closed surface of genus 2")
    found = _of(structure)
    if width is None:
        return found
    wanted = real_number(width, "width", positive=True)
    again = partial(
        conformal_structure, structure.surface, threads=structure._threads, most_faces=most_faces, progress=progress
    )
    for _ in range(MOST_ROUNDS):
        if _excess(found.values, found.errors, wanted) <= 1:
            break
        structure = again(bounds=_needed(structure, wanted))
        found = _of(structure)
        if not structure.refinement.reached:
            break
    return found


def _of(structure):
    omega, radius = _reduced(structure)
    values, errors = enclosed(omega, radius)
    return IgusaInvariants(arrays.frozen(values), arrays.frozen(errors), structure.refinement)


def _reduced(structure):
    return siegel_reduction(structure.period_matrix).period_matrix, period_lattice(structure).radius()


def _excess(values, errors, width):
    """The largest error over the one that is asked for."""
    return float((errors / (width * np.maximum(np.abs(values), SMALL))).max())


def _needed(structure, width):
    """The relative width of the period matrix's bounds from which on, about, the errors are as asked for."""
    omega, radius = _reduced(structure)
    part, excess = 1.0, np.inf
    while excess > 1 and part > np.finfo(float).eps:
        excess = _excess(*enclosed(omega, part * radius), width)
        part /= np.clip(excess, 1, MOST_FINER)
    return SPARE * part * structure.certificate.relative_width


def enclosed(omega, radius):
    """(values, errors), (3,) each, of the invariants where Omega may be off by `radius`, as `Equivalence.residual`: by
    (exp(radius) - 1) S in the metric of Im Omega, S symmetric with spectral norm at most 1.

    Plain ball arithmetic forgets that all errors come from three numbers, the entries of S. In these the invariants are
    summed up as Taylor series; on a ball that is wider, `1 / part` times, plain arithmetic bounds them, and by Cauchy's
    estimates what is left of the series.
    """
    change = np.expm1(radius)
    middle, plain = invariants(omega), invariants(omega, change)
    errors = np.array([ball.error for ball in plain])
    for part in PARTS if change else ():
        wide = np.array([ball.error for ball in invariants(omega, change / part)])
        if np.isfinite(wide).all():
            errors = np.fmin(errors, _series(omega, change / part, wide, part))
    return np.array([ball.value for ball in middle]), errors


def _series(omega, change, most, part):
    """(3,) by how much the invariants change along `part` times `change` S at most, where along `change` S they do by
    less than `most`.

    Coefficients come from values at roots of unity, times `INNER` of `change`; the polydisk of `OUTER` is in the ball.
    """
    roots = INNER * np.exp(2j * np.pi * np.arange(ORDER) / ORDER)
    a, b, c = (each.ravel() for each in np.meshgrid(roots, roots, roots, indexing="ij"))
    steps = np.array([[a, b], [b, c]]).transpose(2, 0, 1)
    root = np.linalg.cholesky(omega.imag)
    found = invariants(omega + change * root @ steps @ root.T)
    values = np.array([ball.value for ball in found]).reshape(3, ORDER, ORDER, ORDER)
    rounding = np.array([ball.error.max() for ball in found])
    degree = np.indices(values.shape[1:]).sum(axis=0)
    taylor = np.abs(np.fft.fftn(values, axes=(1, 2, 3))) / ORDER**3
    mistaken = (1 - (INNER / OUTER) ** ORDER) ** -3 - 1  # coefficients of higher degrees that look the same
    taylor += rounding[:, None, None, None] + mistaken * most[:, None, None, None] * (INNER / OUTER) ** degree
    is_low = (degree > 0) & (degree < ORDER)
    low = (taylor * (part / INNER) ** degree)[:, is_low].sum(axis=1)
    return low + part**ORDER / (1 - part) * most + rounding


def invariants(omega, change=0.0):
    """The three as `Ball`s; `change` as in `even_theta_constants`."""
    fourth = [Ball(value, error) ** 4 for value, error in even_theta_constants(omega, change)]
    inverse = [Ball(1) / theta for theta in fourth]
    h4 = total(theta**2 for theta in fourth)
    h12, h16, quotient = Ball(0), Ball(0), Ball(0)
    for quadruple in goepel_quadruples():
        six = multiplied(fourth[i] for i in range(10) if i not in quadruple)
        h12 = h12 + six
        h16 = h16 + six * total(fourth[i] ** 2 for i in quadruple)
        quotient = quotient + multiplied(inverse[i] for i in quadruple)
    # I2 = h12 / h10, I4 = h4, I6 = h16 / h10, I10 = h10, each times a constant to the power of its weight; h10 is the
    # product of all theta^2, and the quotient h12 / h10^2, in which each error stands once.
    return h12**2 * quotient**3, h12 * h4 * quotient**2, h16 * quotient**2


def goepel_quadruples():
    """The 15 sets of four places among the even characteristics that sum to 0 modulo 2."""
    rows = np.array(even_characteristics(2)).reshape(10, 4)
    return [chosen for chosen in combinations(range(10), 4) if not (rows[list(chosen)].sum(axis=0) % 2).any()]


def even_theta_constants(omega, change=0.0):
    """(value, error) of theta[a, b](0 | Omega), the sum of exp(pi i (n + a/2) Omega (n + a/2) + pi i (n + a/2) b), for
    the `even_characteristics` in their order, of one (g, g) matrix or (k, g, g) several. The exact Omega differs by
    some E with |p E p| <= change p Im Omega p, exp(r) - 1 where it is within r as `Equivalence.residual`. Errors are
    infinite where `change` is 1 or more.
    """
    if change >= 1:
        yield from ((1.0, np.inf) for _ in even_characteristics(omega.shape[-1]))
        return
    least = np.linalg.eigvalsh(omega.imag).min() * (1 - change)
    most = int(np.ceil(np.sqrt(SMALLEST_TERM / (np.pi * least))))
    integers = np.stack(np.meshgrid(*[np.arange(-most, most + 1)] * omega.shape[-1], indexing="ij"), -1)
    for a, b in even_characteristics(omega.shape[-1]):
        n = integers.reshape(-1, omega.shape[-1]) + np.array(a) / 2
        exponents = np.einsum("ki,...ij,kj->...k", n, omega, n)
        terms, energy = np.exp(1j * np.pi * exponents), exponents.imag
        error = np.sum(np.pi * change * energy * np.exp(-np.pi * (1 - change) * energy), axis=-1)
        yield np.sum(terms * np.exp(1j * np.pi * (n @ b)), axis=-1), error + ROUNDING * np.abs(terms).sum(axis=-1)


def even_characteristics(genus):
    """All (a, b) of 0 and 1 with an even a . b."""
    halves = list(product((0, 1), repeat=genus))
    return [(a, b) for a in halves for b in halves if np.dot(a, b) % 2 == 0]


@dataclass(frozen=True)
class Ball:
    """All complex numbers within `error` of `value`, or arrays of them; operations widen them by their own rounding."""

    value: Complexes | complex
    error: Reals | float = 0.0

    def __add__(self, other):
        return _rounded(self.value + other.value, self.error + other.error)

    def __mul__(self, other):
        value = self.value * other.value
        with np.errstate(invalid="ignore"):
            error = np.abs(self.value) * other.error + self.error * (np.abs(other.value) + other.error)
        return _rounded(value, np.where(np.isinf(self.error + other.error), np.inf, error))

    def __truediv__(self, other):
        least = np.abs(other.value) - other.error
        quotient = self.value / other.value
        with np.errstate(divide="ignore", invalid="ignore"):
            error = (self.error + np.abs(quotient) * other.error) / least
        return _rounded(quotient, np.where(least > 0, error, np.inf))

    def __pow__(self, exponent):
        return multiplied([self] * exponent)


def _rounded(value, error):
    return Ball(value, error * (1 + 4 * UNIT) + UNIT * np.abs(value))


def total(balls):
    return sum(balls, Ball(0))


def multiplied(balls):
    result = Ball(1)
    for ball in balls:
        result = result * ball
    return result
