"""The period matrix of a curve y^2 = f(x), from its coefficients."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import arrays
from .array_types import Complexes

FEWEST_NODES, MOST_NODES = 64, 1 << 16  # of a quadrature; twice as many until nothing changes
ROUNDING = 1e-13  # relative, of an integral
APART = 1e-6  # of all roots' size: nearer ones are taken for one


def curve_period_matrix(coefficients: ArrayLike) -> Complexes:
    """(g, g) period matrix of the curve y^2 = f(x), f of degree 2g + 1 or 2g + 2, to about 1e-11: what a mesh may be
    compared with by `conformally_equivalent`.

    coefficients : (d + 1,) real or complex, that of the highest power first: [1, 0, 0, 0, -1, 0] for x^5 - x

    Raises ValueError for a degree below 3, numbers that are not finite, and multiple roots.

    Source: Molin & Neurohr (2019), doi:10.1090/mcom/3351: integrals between branch points by Gauss and Chebyshev. Loop
    i goes around the segment from branch point i to the next, in an order in which no two segments cross.
    """
    roots = _branch_points(coefficients)
    g = (len(roots) - 1) // 2
    loops, end = [], None
    for i in range(2 * g):
        values, begin, far = _integrals(roots, i, g)
        # At the common branch point y goes on counter-clockwise, from the segment before to this one.
        if end is not None:
            turn = np.angle((roots[i + 1] - roots[i]) / (roots[i - 1] - roots[i])) % (2 * np.pi)
            sign = np.sign((begin / (end * np.exp(0.5j * turn))).real)
            values, far = sign * values, sign * far
        loops.append(values)
        end = far
    loops = np.array(loops).T
    # Each loop meets the next once: the sums of every second one are dual to the others.
    a, b = np.cumsum(loops[:, ::2], axis=1), loops[:, 1::2]
    omega = np.linalg.solve(a, b)
    omega = (omega + omega.T) / 2
    return arrays.frozen(omega if omega[0, 0].imag > 0 else -omega)


def _branch_points(coefficients):
    """The roots from left to right."""
    given = np.array(coefficients, dtype=np.complex128)
    if given.ndim != 1 or not np.isfinite(given).all():
        raise ValueError("coefficients must be a row of finite numbers, the highest power first")
    roots = np.roots(given)
    if len(roots) < 3:
        raise ValueError(f"f has the degree {len(roots)}; a curve has periods from degree 3")
    apart = np.abs(roots[:, None] - roots) + np.diag(np.full(len(roots), np.inf))
    if apart.min() < APART * np.abs(roots).max():
        raise ValueError("f has a multiple root, or roots too close together")
    return roots[np.lexsort((roots.imag, roots.real))]


def _integrals(roots, i, g):
    """((g,) integrals of x^k dx / y along the segment i, y over the root of the distance at either end)."""
    a, b, others = roots[i], roots[i + 1], np.delete(roots, (i, i + 1))
    middle, half = (a + b) / 2, (b - a) / 2

    def rest(t):
        """The root of the product over the other branch points, without jumps: no quotient meets the negative axis."""
        x = middle + half * np.atleast_1d(t)[:, None]
        return np.prod(np.sqrt((x - others) / (middle - others)), axis=1) * np.prod(np.sqrt(middle - others))

    count, before = FEWEST_NODES, None
    while count <= MOST_NODES:
        t = np.cos((np.arange(count) + 0.5) * np.pi / count)
        x = middle + half * t
        values = np.pi / count * (x ** np.arange(g)[:, None] / (1j * rest(t))).sum(axis=1)
        if before is not None and np.abs(values - before).max() <= ROUNDING * np.abs(values).max():
            break
        count, before = 2 * count, values
    ends = 1j * half * rest([-1.0, 1.0])
    return values, *ends
