"""Whether a surface is hyperelliptic, a double cover of the sphere, as far as its period matrix tells."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from .. import _native
from .._native import TopologyError
from ..forms.closed import ConformalStructure
from .known_periods import period_lattice
from .siegel import siegel_reduction

SMALLEST_TERM = 40.0  # terms below exp(-this) are left out of a theta series
ROUNDING = 1e-12  # relative: more than that of a term, its exponent below SMALLEST_TERM, and of a reduced period matrix


@dataclass(frozen=True)
class Hyperelliptic:
    """verdict : "yes", "no" or "undecided"
    least : the smallest absolute value of an even theta constant of genus 3, which vanishes on hyperelliptic surfaces
        only; 0 for genus 1 and 2, where all surfaces are
    error : certain bound of its error, from the bounds of the periods
    """

    verdict: str
    least: float = 0.0
    error: float = 0.0


def hyperelliptic(structure: ConformalStructure) -> Hyperelliptic:
    """A `Hyperelliptic` of a closed structure of genus 1 to 3: "yes" where the triangles have a half turn whose
    quotient is a sphere, "no" where the bounds exclude that an even theta constant vanishes. So both are proven.

    Raises TopologyError for other surfaces.
    Source: Fay (1973): theta constants of hyperelliptic curves that vanish; docs/method/equivalence.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> print(holomorph.hyperelliptic(structure).verdict)
    no
    """
    if not isinstance(structure, ConformalStructure) or structure._component.genus > 3:
        raise TopologyError("theta constants recognise hyperelliptic surfaces only if they are closed, of genus 1 to 3")
    component = structure._component
    if component.genus < 3:
        return Hyperelliptic("yes")
    omega = siegel_reduction(structure.period_matrix).period_matrix
    values, errors = map(np.array, zip(*even_theta_constants(omega, np.expm1(period_lattice(structure).radius()))))
    order = np.argsort(np.abs(values), kind="stable")
    sizes, errors = np.abs(values)[order], errors[order]
    verdict = "undecided"
    if _native.has_hyperelliptic_turn(component._native, 3, None):
        verdict = "yes"
    elif structure.period_bounds is not None and (sizes > errors).all():
        verdict = "no"
    return Hyperelliptic(verdict, float(sizes[0]), float(errors[0]))


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
