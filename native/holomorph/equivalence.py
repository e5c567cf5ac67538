"""Whether two surfaces are conformally equivalent (paper § 9, last sentence)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from numpy.typing import ArrayLike

from . import _native
from .array_types import Integers, Progress
from .bounded import BoundedStructure
from .checks import real_number
from .closed import ConformalStructure
from .known_periods import KnownPeriods, period_lattice, side_of
from .planar import LOOPS_OF_ACHIRAL_SURFACES, planar_verdict
from .progress import scaled
from .results import Structure
from .structure import conformal_structure
from .surface import Surface
from .value import Value

ROUNDING = 1e-9  # relative error of residuals
VERDICTS = ("equivalent", "mirror_image", "not_equivalent", "undecided")
STEPS = _native.isometry_steps  # limit of one search among integer matrices


@dataclass(frozen=True, eq=False, repr=False)
class Equivalence(Value):
    """What `conformally_equivalent` found.

    verdict : "equivalent", "mirror_image", "not_equivalent" or "undecided"
    sentence : the verdict and its reason, for people
    matrix : (n, n) integers R, the certificate: row i is class i of b written in the classes of a, R W_a R^T = W_b, or
        -W_b where it reverses the orientation. Closed, n = 2g: the classes dual to `homology_basis`, W their wedge
        matrix; with boundary, n = 2g + b - 1: those of `dirichlet_forms`. The nearest where undecided; None for none
    residual : distance of the two projected period matrices after R, max |log(E_b / E_a)| over the energies E of
        corresponding classes: 0.01 for 1 %. For tori the hyperbolic distance of tau; infinite where there is no matrix
    tolerance : certain bound of the distance of the exact periods: residual and both error bars
    margin : not equivalent: every map between the surfaces, or to the mirror image, stretches some direction at least
        exp(margin) times as much as another, somewhere. Equivalent, mirror image: by how much the residual is below
        what is asked for. Else 0
    """

    verdict: str
    sentence: str
    matrix: Integers | None = None
    residual: float = math.inf
    tolerance: float = math.inf
    margin: float = 0.0

    def _facts(self):
        return [self.sentence]


def conformally_equivalent(
    a: Surface | Structure | ArrayLike,
    b: Surface | Structure | ArrayLike,
    *,
    tolerance: float = 0.0,
    progress: Progress | None = None,
) -> Equivalence:
    """An `Equivalence`: whether there is a conformal map between two connected surfaces.

    By Torelli's theorem there is one if and only if an integer matrix brings the periods of one to those of the other.
    "not_equivalent" is said where the error bars of the periods exclude all integer matrices; "equivalent", or
    "mirror_image", where one brings the projected periods as near as a quarter of the error bars' geometric mean, of
    the other's where one is exact, and the result's `tolerance` says how near the exact ones are for certain;
    "undecided" else. A surface with both is called what it is nearer to.

    Parameters
    ----------
    a, b : Surface, or a structure that was computed of it, or a (g, g) period matrix that is taken for exact, such as
        the `curve_period_matrix` of a known curve
    tolerance : `Equivalence.residual` that counts as none. Error bars are those of the polyhedral surfaces, and 0 tells
        apart two meshes of one smooth surface where their discretisation does: 0.01 takes them for one within 1 %
    progress : progress(fraction, stage), as in `conformal_structure`

    Raises TopologyError for several components, and what `conformal_structure` raises; ValueError for a matrix that is
    none of periods; TypeError for what is neither; Cancelled.

    Cost: that of both structures; the search takes seconds at most, and beyond a limit is "undecided".
    Source: Plesken & Souvignier (1997), with lattice points near a point for its candidates.
    """
    if real_number(tolerance, "tolerance") < 0:
        raise ValueError(f"tolerance is {tolerance!r}; it must not be negative")
    first, second = side_of(a), side_of(b)
    found = _by_topology(first, second)
    if found is not None:
        return found
    structures = [
        _structure(given, part, scaled(progress, start, start + 0.4))
        for given, part, start in ((a, first, 0.0), (b, second, 0.4))
    ]
    lattices = [period_lattice(structure) for structure in structures]
    made = _native.compare(*lattices, allowed=float(tolerance), progress=scaled(progress, 0.8, 1.0))
    verdict, isometry = made.verdict.name, made.isometry
    if verdict == "equivalent" and first.genus == 0 and first.boundary_count > LOOPS_OF_ACHIRAL_SURFACES:
        verdict, isometry = _planar(structures, lattices, made, scaled(progress, 1.0, 1.0))
    is_exact = all(structure.period_bounds is not None for structure in structures)
    return _equivalence(verdict, isometry, made, is_exact)


def _planar(structures, lattices, made, progress):
    """(verdict, isometry): an isometry that keeps the orientation, if any does. All that bring the periods as near as
    is needed are tried, for a symmetric surface has mirror images among its own."""
    verdict = planar_verdict(*structures, made.isometry.matrix)
    if verdict == "equivalent":
        return verdict, made.isometry
    needed = made.isometry.residual + made.margin
    others = _native.isometries(*(lattice.projected() for lattice in lattices), sign=1, slack=needed, progress=progress)
    for isometry in sorted(others.found, key=lambda each: each.residual):
        if planar_verdict(*structures, isometry.matrix) == "equivalent":
            return "equivalent", isometry
    return verdict, made.isometry


def _by_topology(first, second):
    """The `Equivalence` of surfaces whose topology decides it, else None."""
    genus, loops = first.genus, first.boundary_count
    if (genus, loops) != (second.genus, second.boundary_count):
        texts = [part._topology.text() for part in (first, second)]
        return Equivalence("not_equivalent", f"Not equivalent: {texts[0]}, and {texts[1]}.", margin=math.inf)
    if genus == 0 and loops <= 1:
        kind = "disks" if loops else "spheres"
        return Equivalence("equivalent", f"Equivalent: all {kind} are.", residual=0.0, tolerance=0.0)
    return None


def _structure(given, component, progress):
    if isinstance(given, (ConformalStructure, BoundedStructure)):
        return given
    if isinstance(component, KnownPeriods):
        return component
    return conformal_structure(component, progress=progress)


def _equivalence(verdict, isometry, made, is_exact):
    margin, tolerance = made.margin, made.tolerance
    if verdict == "undecided" or (verdict == "not_equivalent" and not is_exact):
        verdict, margin = "undecided", 0.0
    matrix, residual = (isometry.matrix, isometry.residual) if isometry else (None, math.inf)
    if isometry:
        tolerance += residual - made.isometry.residual
    sentence = _sentence(verdict, residual, tolerance, margin, made.is_complete, is_exact)
    return Equivalence(verdict, sentence, matrix, residual, tolerance, margin)


def _sentence(verdict, residual, tolerance, margin, is_complete, is_exact):
    if verdict == "not_equivalent":
        return (
            f"Not equivalent: every map stretches some direction at least {_factor(margin)} times as much as another."
        )
    agree = "agree to rounding" if residual <= ROUNDING else f"differ by {_percent(residual)}"
    near = f"their periods {agree}, with an error certainly below {_percent(tolerance)}"
    if verdict in ("equivalent", "mirror_image"):
        begin = "Equivalent" if verdict == "equivalent" else "Mirror images of each other"
        return f"{begin}: {near}."
    if not is_exact:
        return "Undecided: a surface has degenerate triangles, so the bounds hold for a slightly different one."
    if not is_complete:
        return f"Undecided: the search among integer matrices reached its limit of {STEPS} steps."
    return f"Undecided: {near}; finer meshes have narrower bounds."


def _percent(distance):
    """A logarithm as per cent, rounded up to two digits."""
    value = 100 * math.expm1(distance)
    return f"{_rounded(value, math.ceil):.12g} %"


def _factor(margin):
    return f"{math.floor(math.exp(margin) * 1e4) / 1e4:.5g}"


def _rounded(value, rounding):
    if value == 0 or not math.isfinite(value):
        return value
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return rounding(value / unit) * unit
