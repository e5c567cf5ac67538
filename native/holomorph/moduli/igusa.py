"""Igusa's invariants of surfaces of genus 2, from theta constants."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes
from ..forms.closed import ConformalStructure
from ..forms.results import Structure
from ..mesh.checks import check_type
from .siegel import siegel_reduction

SMALLEST_TERM = 40.0  # terms below exp(-this) are left out of a theta series


def igusa_invariants(structure: ConformalStructure) -> Complexes:
    """Three numbers that tell a surface of genus 2, the curve y^2 = f(x), f of degree 5 or 6: (3,) complex I2^5 / I10,
    I2^3 I4 / I10 and I2^2 I6 / I10, of the invariants I2, I4, I6, I10 of f by Igusa and Clebsch. I10 is the
    discriminant, and the others are sums over products of differences of the roots. Two surfaces with I2 other than 0
    are conformally equivalent if and only if all three agree; those of the mirror image are the conjugate numbers.

    They are of the structure's `period_matrix`, and as exact as that is: where handles are far from each other, I10
    near 0, they are off some hundred times as much, relative to the values. `conformally_equivalent` has bounds.

    Raises TopologyError for other surfaces. Cost: some milliseconds.
    Source: Streng (2014), doi:10.1090/S0025-5718-2013-02712-3, § 7: theta constants, with the invariants' definition by
    Igusa (1960).

    Examples
    --------
    >>> side = 2 * np.sin(np.pi / 8)  # of a regular octagon, whose opposite sides are glued
    >>> edges = [(i % 4, 4 + (i + 1) % 8, 4 + i) for i in range(8)]
    >>> octagon = holomorph.Surface.from_edge_lengths([(1, 0, 0)] * 8, [(side, 1, 1)] * 8, edges)
    >>> structure = holomorph.conformal_structure(octagon, bounds=1e-2)
    >>> print(holomorph.igusa_invariants(structure).real.round())  # as of y^2 = x^5 - x
    [400000. -20000.  -2000.]
    """
    check_type(structure, Structure, "structure")
    if not isinstance(structure, ConformalStructure) or structure._component.genus != 2:
        raise TopologyError("Igusa's invariants need a closed surface of genus 2")
    return arrays.frozen(invariants(siegel_reduction(structure.period_matrix).period_matrix))


def invariants(omega):
    """(3,) of a period matrix, best a reduced one."""
    fourth = even_theta_constants(omega) ** 4
    chosen = goepel_quadruples()
    six = np.array([np.delete(fourth, quadruple).prod() for quadruple in chosen])
    # I2 = h12 / h10, I4 = h4, I6 = h16 / h10, I10 = h10, each times a constant to the power of its weight; h10 is the
    # product of all theta^2, and the quotient h12 / h10^2, in which each rounding stands once.
    h4, h12, h16 = np.sum(fourth**2), six.sum(), six @ np.sum(fourth[chosen] ** 2, axis=1)
    quotient = np.sum(1 / fourth[chosen].prod(axis=1))
    return np.array([h12**2 * quotient**3, h12 * h4 * quotient**2, h16 * quotient**2])


def goepel_quadruples():
    """(15, 4): the sets of four places among the even characteristics that sum to 0 modulo 2."""
    rows = np.array(even_characteristics(2)).reshape(10, 4)
    return np.array([four for four in combinations(range(10), 4) if not (rows[list(four)].sum(axis=0) % 2).any()])


def even_theta_constants(omega):
    """theta[a, b](0 | Omega), the sum of exp(pi i (n + a/2) Omega (n + a/2) + pi i (n + a/2) b), for the
    `even_characteristics` in their order, of a (g, g) matrix."""
    least = np.linalg.eigvalsh(omega.imag).min()
    most = int(np.ceil(np.sqrt(SMALLEST_TERM / (np.pi * least))))
    integers = np.stack(np.meshgrid(*[np.arange(-most, most + 1)] * len(omega), indexing="ij"), -1)
    integers = integers.reshape(-1, len(omega))
    return np.array([_theta(omega, integers + np.array(a) / 2, b) for a, b in even_characteristics(len(omega))])


def _theta(omega, n, b):
    return np.sum(np.exp(1j * np.pi * (np.einsum("ki,ij,kj->k", n, omega, n) + n @ b)))


def even_characteristics(genus):
    """All (a, b) of 0 and 1 with an even a . b."""
    halves = list(product((0, 1), repeat=genus))
    return [(a, b) for a in halves for b in halves if np.dot(a, b) % 2 == 0]
