"""Whether a surface is hyperelliptic, a double cover of the sphere, as far as its period matrix tells."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from ._native import TopologyError
from .closed import ConformalStructure
from .equivalence import period_lattice
from .siegel import siegel_reduction

SMALLEST_TERM = 40.0  # terms below exp(-this) are left out of a theta series
ROUNDING = 1e-12  # relative: more than that of a term, its exponent below SMALLEST_TERM, and of a reduced period matrix


@dataclass(frozen=True)
class Hyperelliptic:
    """verdict : "yes", "no" or "undecided"
    least : the smallest absolute value of an even theta constant of genus 3, which vanishes just on hyperelliptic
        surfaces; 0 for genus 1 and 2, where all surfaces are
    error : certain bound of its error, from the bounds of the periods
    """

    verdict: str
    least: float = 0.0
    error: float = 0.0


def hyperelliptic(structure: ConformalStructure) -> Hyperelliptic:
    """A `Hyperelliptic` of a closed structure of genus 1 to 3: "no" where the bounds exclude that an even theta
    constant vanishes, "yes" where one is below half of the bound of its error.

    Raises TopologyError for other surfaces.
    """
    genus = structure._component.genus
    if not isinstance(structure, ConformalStructure) or genus > 3:
        raise TopologyError(f"theta constants tell hyperelliptic surfaces up to genus 3; the surface has genus {genus}")
    if genus < 3:
        return Hyperelliptic("yes")
    omega = siegel_reduction(structure.period_matrix).period_matrix
    values, errors = zip(*even_theta_constants(omega, period_lattice(structure).radius()))
    sizes, errors = np.abs(values), np.array(errors)
    i = int(np.argmin(sizes))
    if (sizes > errors).all():
        return Hyperelliptic("no", float(sizes[i]), float(errors[i]))
    return Hyperelliptic("yes" if sizes[i] <= errors[i] / 2 else "undecided", float(sizes[i]), float(errors[i]))


def even_theta_constants(omega, radius=0.0):
    """(value, error) of theta[a, b](0 | Omega), the sum of exp(pi i (n + a/2) Omega (n + a/2) + pi i (n + a/2) b), for
    the `even_characteristics` in their order; `radius` is how far Omega may be from the exact one, as
    `Equivalence.residual`: then |p dOmega p| <= (exp(radius) - 1) p Im Omega p.
    """
    least = np.linalg.eigvalsh(omega.imag).min() * np.exp(-radius)
    most = int(np.ceil(np.sqrt(SMALLEST_TERM / (np.pi * least)))) + 1
    integers = np.stack(np.meshgrid(*[np.arange(-most, most + 1)] * len(omega), indexing="ij"), -1)
    for a, b in even_characteristics(len(omega)):
        n = integers.reshape(-1, len(omega)) + np.array(a) / 2
        energy = np.einsum("ki,ij,kj->k", n, omega.imag, n)
        terms = np.exp(1j * np.pi * np.einsum("ki,ij,kj->k", n, omega, n))
        error = np.sum(np.pi * np.expm1(radius) * energy * np.exp(-np.pi * np.exp(-radius) * energy))
        yield np.sum(terms * np.exp(1j * np.pi * (n @ b))), error + ROUNDING * np.abs(terms).sum()


def even_characteristics(genus):
    """All (a, b) of 0 and 1 with an even a . b."""
    halves = list(product((0, 1), repeat=genus))
    return [(a, b) for a in halves for b in halves if np.dot(a, b) % 2 == 0]
