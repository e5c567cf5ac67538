"""Igusa's invariants of surfaces of genus 2, with intervals, from theta constants."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from . import arrays
from ._native import TopologyError
from .array_types import Complexes, Reals
from .checks import check_type
from .closed import ConformalStructure
from .equivalence import period_lattice
from .results import Structure
from .siegel import siegel_reduction
from .theta_constants import even_characteristics, even_theta_constants
from .value import Value

ROUNDING = 2.0**-50  # relative, of one operation on complex numbers and of the error's own


@dataclass(frozen=True, eq=False, repr=False)
class IgusaInvariants(Value):
    """Two surfaces of genus 2 with I2 other than 0 are conformally equivalent just if these three agree.

    values : (3,) complex I2^5 / I10, I2^3 I4 / I10, I2^2 I6 / I10 of the Igusa-Clebsch invariants I2, I4, I6, I10 of
        the curve y^2 = f(x), f of degree 5 or 6
    errors : (3,) the exact ones of the polyhedral surface are certainly within these distances (where the certificate's
        bounds hold); infinite where the bounds of the periods allow I10 = 0
    """

    values: Complexes
    errors: Reals

    def _facts(self):
        # Two digits change the error by 5 % at most: what is printed is not below it.
        return [f"{complex(value):.6g} +- {1.06 * error:.2g}" for value, error in zip(self.values, self.errors)]


def igusa_invariants(structure: ConformalStructure) -> IgusaInvariants:
    """The `IgusaInvariants` of a closed structure of genus 2. Those of the mirror image are the conjugate numbers.

    Raises TopologyError for other surfaces.

    Source: Streng (2014), doi:10.1090/S0025-5718-2013-02712-3, § 7: theta constants, with the invariants' definition by
    Igusa (1960).
    """
    check_type(structure, Structure, "structure")
    if not isinstance(structure, ConformalStructure) or structure._component.genus != 2:
        raise TopologyError("Igusa's invariants belong to closed surfaces of genus 2")
    omega = siegel_reduction(structure.period_matrix).period_matrix
    balls = invariants(omega, period_lattice(structure).radius())
    return IgusaInvariants(
        arrays.frozen(np.array([ball.value for ball in balls])), arrays.frozen(np.array([ball.error for ball in balls]))
    )


def invariants(omega, radius=0.0):
    """The three as `Ball`s; `radius` as in `even_theta_constants`."""
    fourth = [Ball(value, error) ** 4 for value, error in even_theta_constants(omega, radius)]
    h4 = total(theta**2 for theta in fourth)
    h20 = product(fourth)  # the square of h10, the product of all theta^2
    h12, h16 = Ball(0), Ball(0)
    for quadruple in goepel_quadruples():
        six = product(fourth[i] for i in range(10) if i not in quadruple)
        h12 = h12 + six
        h16 = h16 + six * total(fourth[i] ** 2 for i in quadruple)
    # I2 = h12 / h10, I4 = h4, I6 = h16 / h10, I10 = h10, each times a constant to the power of its weight.
    return h12**5 / h20**3, h12**3 * h4 / h20**2, h12**2 * h16 / h20**2


def goepel_quadruples():
    """The 15 sets of four places among the even characteristics that sum to 0 modulo 2."""
    rows = np.array(even_characteristics(2)).reshape(10, 4)
    return [chosen for chosen in combinations(range(10), 4) if not (rows[list(chosen)].sum(axis=0) % 2).any()]


@dataclass(frozen=True)
class Ball:
    """All complex numbers within `error` of `value`; operations widen it by their own rounding."""

    value: complex
    error: float = 0.0

    def __add__(self, other):
        return _rounded(self.value + other.value, self.error + other.error)

    def __mul__(self, other):
        error = abs(self.value) * other.error + self.error * (abs(other.value) + other.error)
        return _rounded(self.value * other.value, error)

    def __truediv__(self, other):
        least = abs(other.value) - other.error
        if least <= 0:
            return Ball(self.value / other.value, np.inf)
        quotient = self.value / other.value
        return _rounded(quotient, (self.error + abs(quotient) * other.error) / least)

    def __pow__(self, exponent):
        return product([self] * exponent)


def _rounded(value, error):
    return Ball(value, error * (1 + 4 * ROUNDING) + ROUNDING * abs(value))


def total(balls):
    return sum(balls, Ball(0))


def product(balls):
    result = Ball(1)
    for ball in balls:
        result = result * ball
    return result
