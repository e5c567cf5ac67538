"""What Sp(2g, Z) makes of periods: reduced period matrices, Igusa's invariants, and the symmetries of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import Error, TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress
from ..core.value import Value, counted
from ..forms.certificate import PeriodMatrix, checked_period_matrix
from ..forms.results import Structure
from ..forms.structure import ConformalStructure
from ..mesh.checks import check_type, real_number
from .equivalence import AGREEMENT, ROUNDING, STEPS, period_lattice

CONVENTION = (
    "Im Omega is reduced (LLL, 0.99), |Re Omega| <= 1/2, |Omega_11| >= 1; for genus 1 that is the fundamental domain "
    "of SL(2, Z), on its edge Re tau >= 0"
)
ON_THE_EDGE = 1e-9  # a number within it of the edge of the domain is on it, so that the reduction ends
MOST_STEPS = 1000
SMALLEST_TERM = 40.0  # terms below exp(-this) are left out of a theta series
GAP = 1e-6  # part of what is allowed: residuals that differ by less belong to the same symmetry of the mesh


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
        if abs(omega[0, 0]) >= 1 - ON_THE_EDGE:
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
    return np.where(np.abs(real) <= 0.5 + ON_THE_EDGE, 0, np.rint(real)).astype(np.int64)


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
    if omega[0, 0].real <= -0.5 + ON_THE_EDGE:
        step = np.array([[1, 1], [0, 1]])
    elif omega[0, 0].real < -ON_THE_EDGE and abs(omega[0, 0]) <= 1 + ON_THE_EDGE:
        step = np.array([[0, -1], [1, 0]])
    else:
        return omega, matrix
    return moved(omega, step), step @ matrix


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


@dataclass(frozen=True, eq=False, repr=False)
class Automorphisms(Value):
    """What `automorphisms` found.

    order : number of integer matrices that keep the wedge product and the energies, for genus >= 2 the conformal maps
        of the surface to itself where it is hyperelliptic, twice as many where it is not (Torelli: -1 comes from a map
        on hyperelliptic surfaces alone); for genus 1 those that fix a point
    generators : tuple of (2g, 2g) integers in the classes dual to `homology_basis`, as `Equivalence.matrix`
    tolerance : the largest residual of the group's matrices, as `Equivalence.residual`: the surface is that near to one
        with these symmetries
    at_most : number of matrices that the bounds of the periods do not exclude: the order of the surface's own group is
        certainly not larger. None where the search for them reached its limit
    """

    order: int
    generators: tuple[Integers, ...]
    tolerance: float
    at_most: int | None

    def _facts(self):
        return [f"order {self.order}", counted(len(self.generators), "generator"), f"tolerance {self.tolerance:.2g}"]


def automorphisms(
    structure: ConformalStructure, *, tolerance: float = 0.0, progress: Progress | None = None
) -> Automorphisms:
    """The `Automorphisms` of a closed structure: the largest group of integer matrices that bring the projected periods
    to themselves within a quarter of their bounds, or `tolerance` if that is larger.

    tolerance : `Equivalence.residual` that counts as none: a mesh of a symmetric surface need not be symmetric itself

    Raises TypeError for another kind of structure; Error where the search reaches its limit; Cancelled.

    Cost: grows with the number of matrices that the bounds allow.
    Source: Plesken & Souvignier (1997), as in `conformally_equivalent`.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(holomorph.automorphisms(structure).order)
    4
    """
    if not isinstance(structure, ConformalStructure):
        raise TypeError(f"automorphisms need the structure of a closed surface, not a {type(structure).__name__}")
    lattice = period_lattice(structure)
    allowed = max(real_number(tolerance, "tolerance"), AGREEMENT * lattice.radius(), ROUNDING)
    projected = lattice.projected()
    found, is_complete = _native.isometries(projected, projected, sign=1, slack=allowed, progress=progress)
    if not is_complete:
        raise Error(f"the search among integer matrices reached its limit of {STEPS} steps")
    found = sorted(found, key=lambda isometry: isometry.residual)
    matrices, residuals = np.array([each.matrix for each in found]), np.array([each.residual for each in found])
    count, generators = _largest_group(matrices, residuals, allowed)
    others, is_complete = _native.isometries(lattice, lattice, sign=1, slack=0.0, progress=progress)
    at_most = len(others) if is_complete else None
    return Automorphisms(count, tuple(matrices[generators]), float(residuals[count - 1]), at_most)


def _largest_group(matrices, residuals, allowed):
    """(count, generators): of the matrices, nearest first, the number in the largest group, and the places of some that
    generate it. Residuals that are almost the same belong to the same symmetries."""
    ends = np.flatnonzero(np.diff(residuals, append=np.inf) > GAP * allowed) + 1
    for count in ends[::-1]:
        generators = _generators(matrices[:count])
        if generators is not None:
            return int(count), generators
    raise Error("the symmetries of the periods do not form a group")


def _generators(matrices):
    """Places of few matrices that generate all; None where these are no group. A finite set is one if it is closed
    under products with matrices whose products reach all of it."""
    places = {matrix.tobytes(): i for i, matrix in enumerate(matrices)}
    reached = np.zeros(len(matrices), bool)
    reached[places[np.eye(matrices.shape[1], dtype=matrices.dtype).tobytes()]] = True
    chosen, moves = [], []
    while not reached.all():
        chosen.append(int(np.argmin(reached)))
        products = np.ascontiguousarray(matrices @ matrices[chosen[-1]])
        moves.append(np.array([places.get(product.tobytes(), -1) for product in products]))
        if (moves[-1] < 0).any():
            return None
        before = 0
        while reached.sum() > before:
            before = reached.sum()
            for move in moves:
                reached[move[reached]] = True
    return chosen
