"""The period matrix of a curve y^2 = f(x), from its coefficients, with a bound of its error."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import SolverError
from ..core import arrays
from ..forms.period_matrix import PeriodMatrix, distance_within

EPS = np.finfo(float).eps
TRUNCATION = 1e-20  # of an integral, relative to the bound of its integrand
ELLIPSE = 0.9  # part of the way to the nearest singularity on which the integrand is bounded
MOST_NODES = 1 << 18  # of a quadrature: enough beside branch points that are 1e-8 of the edge apart
STEPS = 4  # of Weierstrass's iteration, which squares the errors of roots that are near already
MOST_ERROR = 0.7  # of a matrix: its entries may be twice as large
APART = 0.1  # of the distance of two branch points: each is known to less than this


def curve_period_matrix(coefficients: ArrayLike) -> PeriodMatrix:
    """The `PeriodMatrix`, (g, g), of the curve y^2 = f(x), f of degree 2g + 1 or 2g + 2: what a mesh may be compared
    with by `conformally_equivalent`.

    Its `error` bounds the errors of the integrals and of the branch points. Integer coefficients are exact, others are
    only known to their rounding, and roots near each other make that large.

    coefficients : (d + 1,) real or complex, that of the highest power first: [1, 0, 0, 0, -1, 0] for x^5 - x

    Raises ValueError for a degree below 3, numbers that are not finite, and roots that rounding does not tell apart;
    SolverError for roots too close together to be integrated between.

    Source: Molin & Neurohr (2019), doi:10.1090/mcom/3351: integrals between branch points by Gauss and Chebyshev, along
    a tree. Theirs has the fastest integrals, ours the shortest edges, of which no two cross and no two meet at an angle
    below 60 degrees.

    Examples
    --------
    >>> periods = holomorph.curve_period_matrix([1, 0, 0, -1])  # y^2 = x^3 - 1
    >>> print(holomorph.siegel_reduction(periods).period_matrix.round(3))
    [[0.5+0.866j]]
    """
    with np.errstate(all="ignore"):  # what is not finite leaves no bound of the error
        return _period_matrix(*_branch_points(coefficients))


def _period_matrix(roots, radii):
    g = (len(roots) - 1) // 2
    edges = _tree(roots, 2 * g)
    used = roots[np.unique(edges)]
    middle, scale = used.mean(), np.abs(used - used.mean()).max()
    roots, radii = (roots - middle) / scale, radii / scale
    loops = [_integrals(roots, edge, g) for edge in edges]
    values, errors = (np.array([loop[k] for loop in loops]).T for k in range(2))
    basis = _native.symplectic_basis(_intersections(edges, np.array([loop[2] for loop in loops])))
    try:
        omega, change = _solved(values @ basis.T, errors @ np.abs(basis).T, roots, radii)
        error = distance_within(omega, change)
    except np.linalg.LinAlgError:  # a singular matrix
        error = np.inf
    if not error < MOST_ERROR:
        raise SolverError("the branch points are too close together: rounding leaves no digit of the period matrix")
    return PeriodMatrix.of(omega, error)


def _solved(periods, errors, roots, radii):
    """(omega, change): a^-1 b of the periods (a, b), symmetric, and how much its entries may change."""
    g = len(periods)
    a, b = periods[:, :g], periods[:, g:]
    inverse = np.linalg.inv(a)
    omega = np.linalg.solve(a, b)
    error = np.abs(inverse) @ (errors[:, g:] + errors[:, :g] @ np.abs(omega))
    error += _rounding(a, inverse, omega) + _from_roots(roots, radii, inverse)
    return (omega + omega.T) / 2, (error + error.T) / 2


def _branch_points(coefficients):
    """(roots, radii), over a power of 2: the exact roots are within these distances, one each. Integer coefficients are
    exact; others have errors as large as those of a product of factors in double precision."""
    given = arrays.complex_numbers(coefficients, "coefficients")
    if given.ndim != 1 or not np.isfinite(given).all():
        raise ValueError("coefficients must be a row of finite numbers, the highest power first")
    c = np.trim_zeros(given, "f")
    monic = c / c[0] if len(c) else c
    if not np.isfinite(monic).all():
        raise ValueError("the first coefficient is too small beside the others")
    roots = np.roots(monic)
    if len(roots) < 3:
        raise ValueError(f"f has the degree {len(roots)}; a curve has periods from degree 3")
    size = 2.0 ** np.ceil(np.log2(np.abs(roots).max() or 1.0))
    roots = roots / size
    for _ in range(STEPS):
        roots = roots - _corrections(c, size, roots)
    apart = _differences(roots, np.inf)
    radii = np.abs(_corrections(c, size, roots)) + EPS * np.abs(roots)
    if not (c == np.rint(c)).all():
        growth = np.prod((np.abs(roots)[:, None] + np.abs(roots)) / np.abs(apart) + np.eye(len(roots)), axis=1)
        radii += 4 * len(roots) * EPS * np.abs(roots) * growth
    if not (2 * radii < APART * np.abs(apart).min(axis=1)).all():
        raise ValueError("f has a multiple root, or roots that are closer together than rounding can tell")
    return roots, 2 * radii


def _differences(roots, diagonal):
    apart = roots[:, None] - roots
    np.fill_diagonal(apart, diagonal)
    return apart


def _corrections(c, size, roots):
    """f(u) / (c_0 prod (u - u_j)) over the other roots u_j (Weierstrass); 0 where two are the same number.

    f is evaluated in fractions: roots near each other leave it few digits."""
    if not np.isfinite(roots).all():
        return np.full_like(roots, np.inf)
    _, exponent = np.frexp(np.abs(c[0]))
    unit = Fraction(2) ** -int(exponent)
    units = [unit / Fraction(size) ** k for k in range(len(c))]
    exact = [(Fraction(a.real) * unit, Fraction(a.imag) * unit) for a, unit in zip(c, units, strict=True)]
    values = np.array([_value(exact, Fraction(u.real), Fraction(u.imag)) for u in roots])
    product = np.ldexp(1.0, -exponent) * c[0] * np.prod(_differences(roots, 1), axis=1)
    return np.divide(values, product, out=np.zeros_like(roots), where=product != 0)


def _value(exact, x, y):
    real = imaginary = Fraction(0)
    for a, b in exact:
        real, imaginary = real * x - imaginary * y + a, real * y + imaginary * x + b
    try:
        return complex(real, imaginary)
    except OverflowError:
        return complex(np.inf)


def _tree(roots, count):
    """(count, 2) indices: edges of a tree of least length (Prim). Leaves of the longest edges are dropped until it has
    `count` edges: the curve over a disk with all branch points but one has all loops."""
    apart = np.abs(_differences(roots, np.inf))
    inside, edges = np.arange(len(roots)) == 0, []
    for _ in range(len(roots) - 1):
        cut = np.where(inside[:, None] & ~inside, apart, np.inf)
        edge = np.unravel_index(np.argmin(cut), cut.shape)
        inside[edge[1]] = True
        edges.append(edge)
    edges = np.array(edges)
    while len(edges) > count:
        is_leaf = (np.bincount(edges.ravel(), minlength=len(roots))[edges] == 1).any(axis=1)
        edges = np.delete(edges, np.argmax(np.where(is_leaf, apart[tuple(edges.T)], 0)), axis=0)
    return edges


def _integrals(roots, edge, g):
    """(values, errors, ends) along an edge: (g,) integrals of x^k dx / y, bounds of their errors, and (2,) y at the
    ends over the square root of their distance, times a positive number."""
    a, b = roots[edge]
    middle, half = (a + b) / 2, (b - a) / 2
    others = (np.delete(roots, edge) - middle) / half

    def rest(t):
        """The root of the product over the other branch points, without jumps: no quotient meets the negative axis."""
        return np.prod(np.sqrt(1 - np.atleast_1d(t)[:, None] / others), axis=1) * start

    start = np.prod(np.sqrt(-others * half))
    # The integrand is bounded on the ellipse cosh(r + i s) by that ellipse's distances to the other branch points.
    away = np.abs(np.arccosh(others + 0j).real)
    r = ELLIPSE * away.min()
    bound = np.prod(np.abs(half) * (np.cosh(away) - np.cosh(r))) ** -0.5
    powers = (np.abs(middle) + np.abs(half) * np.cosh(r)) ** np.arange(g)
    count = int(np.ceil((np.log(2 * np.pi) - np.log(TRUNCATION)) / (2 * r))) if r > 0 else MOST_NODES + 1
    if count > MOST_NODES:
        raise SolverError(
            f"two branch points are too close together: an integral beside them needs more than {MOST_NODES} nodes"
        )
    t = np.cos((np.arange(count) + 0.5) * np.pi / count)
    terms = np.pi / count * (middle + half * t) ** np.arange(g)[:, None] / (1j * rest(t))
    # Differences to branch points nearby have larger relative errors.
    rounding = EPS * (2 * g + np.log2(count) + 4 * (1 + 1 / np.abs(1 - t[:, None] / others)).sum(axis=1))
    errors = TRUNCATION * bound * powers + (np.abs(terms) * rounding).sum(axis=1)
    return terms.sum(axis=1), errors, 1j * half * rest([-1.0, 1.0])


def _intersections(edges, ends):
    """(n, n) intersection numbers of the loops that go along each edge and return on the other sheet.

    They meet over common branch points u, where sqrt(x - u) is a chart in which y is linear: a loop goes through 0 in
    the direction of y, or of -y at the end of its edge."""
    result = np.zeros((len(edges), len(edges)), np.int64)
    for u in np.unique(edges):
        loops, place = np.nonzero(edges == u)
        direction = ends[loops, place] * (1 - 2 * place)
        result[np.ix_(loops, loops)] += np.sign((direction[:, None].conj() * direction).imag).astype(np.int64) * (
            1 - np.eye(len(loops), dtype=np.int64)
        )
    return result


def _rounding(a, inverse, omega):
    """(g, g) error of the solution of a linear system."""
    return 4 * len(a) * EPS * (np.abs(inverse) @ np.abs(a) @ np.abs(omega) + np.abs(omega))


def _from_roots(roots, radii, inverse):
    """(g, g) error from branch points within `radii` of the exact ones, by Rauch's formula: the derivative by u is
    pi i v v^T of the normalised forms' values v in the chart sqrt(x - u) (Fay 1973, doi:10.1007/BFb0060090)."""
    slopes = np.abs(np.prod(_differences(roots, 1), axis=1))
    values = np.abs(inverse @ roots ** np.arange(len(inverse))[:, None]) / np.sqrt(slopes)
    return np.pi * (values * (radii + 2 * EPS)) @ values.T
