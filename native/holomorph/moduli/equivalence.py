"""Whether two surfaces are conformally equivalent (paper § 9, last sentence)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress
from ..core.progress import scaled
from ..core.value import Value, quoted
from ..forms.certificate import checked_period_matrix, distance_within
from ..forms.results import Structure
from ..forms.structure import BoundedStructure, ConformalStructure, conformal_structure
from ..mesh.checks import only_component, real_number
from ..mesh.surface import Surface

ROUNDING = 1e-9  # relative error of residuals
AGREEMENT = 0.25  # of the error bars: projected periods are more accurate, so meshes of one surface agree to less
NEAR = 0.01  # a distance that is certainly smaller needs no narrower bounds
BARS = 0.25  # of what is to be seen: width of the bounds for it, twice the error bar of each surface
MOST_NARROWINGS = 3
VERDICTS = ("equivalent", "indistinguishable", "mirror_image", "not_equivalent", "undecided")
AGREEING = VERDICTS[:3]
STEPS = _native.isometry_steps  # limit of one search among integer matrices
LOOPS_OF_ACHIRAL_SURFACES = 3
"""Disks, annuli and pairs of pants are their own mirror images."""

SAMPLES = 200  # triangles of the first surface that are looked for on the second
CLEARLY = 4.0  # by this factor the one has to fit better
ALIKE = 1e-2  # both do where neither misses by more


@dataclass(frozen=True, eq=False, repr=False)
class Equivalence(Value):
    """What `conformally_equivalent` found.

    verdict : "equivalent" where that is proven: by the topology, or by numbers that are the same as far as they are
        exact: one factor takes all lengths of the one triangulation to those of the other, however they are numbered,
        moved and turned, or an integer matrix takes one given period matrix to the other. Given lengths are exact to
        2.5 units of rounding, 2^-53, coordinates and periods to one. "indistinguishable" where the bounds do not tell
        the surfaces apart. "mirror_image", proven or not; "not_equivalent", always proven; "undecided"
    is_proven : whether no error of the mesh or of the periods can make the verdict wrong
    sentence : the verdict and its reason, for people
    matrix : (n, n) integers R, the certificate: row i is class i of b written in the classes of a, R W_a R^T = W_b, or
        -W_b where it reverses the orientation. Closed, n = 2g: the classes dual to `homology_basis`, W their wedge
        matrix; with boundary, n = 2g + b - 1: those of `dirichlet_forms`. The nearest where undecided; None for none
    residual : distance of the two projected period matrices after R, max |log(E_b / E_a)| over the energies E of
        corresponding classes: 0.01 for 1 %. For tori the hyperbolic distance of tau; infinite where there is no matrix
    tolerance : certain bound of the distance of the exact periods: residual and both error bars. Infinite where a
        surface has degenerate triangles
    margin : not equivalent: every map between the surfaces, or to the mirror image, stretches some direction at least
        exp(margin) times as much as another, somewhere. Where periods agree: by how much the residual is below what is
        asked for. Else 0
    """

    verdict: str
    sentence: str
    matrix: Integers | None = None
    residual: float = math.inf
    tolerance: float = math.inf
    margin: float = 0.0
    is_proven: bool = False

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
    "not_equivalent" is said where the error bars of the periods exclude all integer matrices; "indistinguishable", or
    "mirror_image", where one brings the projected periods as near as a quarter of the error bars' geometric mean, of
    the other's where one is exact, and the result's `tolerance` says how near the exact ones are for certain;
    "undecided" else. A surface with both is called what it is nearer to. "equivalent" needs a proof, see `Equivalence`.
    Bounds are narrowed until the verdict is decided and the distance is certainly below 1 %, or `tolerance`.

    Parameters
    ----------
    a, b : Surface, or a structure that was computed of it, or a (g, g) period matrix, such as that of a known curve. It
        is exact to rounding, or as far as it is symmetric, or to its `error`, see `PeriodMatrix`
    tolerance : `Equivalence.residual` that counts as none. Error bars are those of the polyhedral surfaces, and 0 tells
        apart two meshes of one smooth surface where their discretisation does: 0.01 takes them for one within 1 %
    progress : progress(fraction, stage), as in `conformal_structure`

    Raises TopologyError for several components, and what `conformal_structure` raises; ValueError for a matrix that is
    none of periods; TypeError for what is neither; Cancelled.

    Cost: that of both structures, with `bounds` up to three times; the search takes seconds at most, and beyond a limit
    is "undecided".
    Source: Plesken & Souvignier (1997), with lattice points near a point for its candidates.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> print(holomorph.conformally_equivalent(surface, surface).verdict)
    equivalent
    """
    tolerance = checked_tolerance(tolerance)
    first, second = side_of(a), side_of(b)
    found = by_topology(first, second)
    if found is not None:
        return found
    sides = (a, first), (b, second)
    structures = [_structure(*sides[i], scaled(progress, 0.2 * i, 0.2 * i + 0.2)) for i in range(2)]
    found = compared(structures, tolerance, scaled(progress, 0.4, 0.5))
    for k in range(MOST_NARROWINGS):
        near = max(NEAR, tolerance)
        if found.is_proven or (found.verdict != "undecided" and found.tolerance <= near):
            break
        width = BARS * min(near, found.residual if found.verdict == "undecided" else near)
        step = scaled(progress, 0.5 + k / 6, 0.5 + (k + 1) / 6)
        narrower = [_narrower(structures[i], width, scaled(step, 0.4 * i, 0.4 * i + 0.4)) for i in range(2)]
        if narrower == structures:
            break
        structures = narrower
        found = compared(structures, tolerance, scaled(step, 0.8, 1.0))
    return found


def checked_tolerance(tolerance):
    if real_number(tolerance, "tolerance") < 0:
        raise ValueError(f"tolerance is {quoted(tolerance)}; it must not be negative")
    return float(tolerance)


def compared(structures, tolerance, progress):
    """The `Equivalence` of two structures or `KnownPeriods` of one topology, by the bounds that they have."""
    sides = [side_of(each) if isinstance(each, Structure) else each for each in structures]
    lattices = [period_lattice(structure) for structure in structures]
    is_known = any(isinstance(structure, KnownPeriods) for structure in structures)
    needed = AGREEMENT * _common_bars(*(lattice.radius() for lattice in lattices), is_known)
    made = _native.compare(*lattices, allowed=tolerance, needed=needed, progress=scaled(progress, 0.0, 0.5))
    verdict, isometry = made.verdict, made.isometry
    if verdict == "indistinguishable" and sides[0].genus == 0 and sides[0].boundary_count > LOOPS_OF_ACHIRAL_SURFACES:
        verdict, isometry = _planar(structures, lattices, made, scaled(progress, 0.5, 0.5))
    is_bounded = all(structure.period_bounds is not None for structure in structures)
    found = _equivalence(verdict, isometry, made, is_bounded)
    return found if found.verdict == "not_equivalent" else _proven(found, *sides, scaled(progress, 0.5, 1.0))


def _narrower(structure, width, progress):
    """The structure with bounds of this relative width, if they can be had."""
    if isinstance(structure, KnownPeriods) or not structure.certificate.relative_width > width:
        return structure
    if not structure._native.memory().keeps_forms:
        return structure
    return conformal_structure(structure.surface, bounds=width, threads=structure._threads, progress=progress)


def _common_bars(first, second, is_known):
    """For two meshes the geometric mean, so that a coarse one is not taken for all that it may be; the larger one where
    a mesh is exact, or periods are known without a mesh."""
    return max(first, second) if is_known or min(first, second) <= ROUNDING else math.sqrt(first * second)


def _planar(structures, lattices, made, progress):
    """(verdict, isometry): an isometry that keeps the orientation, if any does. All that bring the periods as near as
    is needed are tried, for a symmetric surface has mirror images among its own."""
    verdict = planar_verdict(*structures, made.isometry.matrix)
    if verdict == "indistinguishable":
        return verdict, made.isometry
    needed = made.isometry.residual + made.margin
    others, _ = _native.isometries(
        *(lattice.projected() for lattice in lattices), sign=1, slack=needed, progress=progress
    )
    for isometry in sorted(others, key=lambda each: each.residual):
        if planar_verdict(*structures, isometry.matrix) == "indistinguishable":
            return "indistinguishable", isometry
    return verdict, made.isometry


def by_topology(first, second):
    """The `Equivalence` of surfaces whose topology decides it, else None."""
    genus, loops = first.genus, first.boundary_count
    if (genus, loops) != (second.genus, second.boundary_count):
        texts = [part._topology.text() for part in (first, second)]
        return Equivalence(
            "not_equivalent", f"Not equivalent: {texts[0]}, and {texts[1]}.", margin=math.inf, is_proven=True
        )
    if genus == 0 and loops <= 1:
        kind = "disks" if loops else "spheres"
        sentence = f"Equivalent: all {kind} are."
        return Equivalence("equivalent", sentence, residual=0.0, tolerance=0.0, is_proven=True)
    return None


def _structure(given, component, progress):
    if isinstance(given, (ConformalStructure, BoundedStructure)):
        return given
    if isinstance(component, KnownPeriods):
        return component
    return conformal_structure(component, progress=progress)


def _equivalence(verdict, isometry, made, is_bounded):
    margin, tolerance = made.margin, made.tolerance if is_bounded else math.inf
    if verdict == "undecided" or (verdict == "not_equivalent" and not is_bounded):
        verdict, margin = "undecided", 0.0
    matrix, residual = (isometry.matrix, isometry.residual) if isometry else (None, math.inf)
    if isometry:
        tolerance += residual - made.isometry.residual
    found = Equivalence(verdict, "", matrix, residual, tolerance, margin, verdict == "not_equivalent")
    return replace(found, sentence=_sentence(found, made.is_complete, is_bounded))


def _proven(found, first, second, progress):
    """What was found, with the proof of an equivalence if there is one, or with what triangles tell of the distance."""
    known = [isinstance(side, KnownPeriods) for side in (first, second)]
    if all(known) and first.is_exact and second.is_exact and found.residual <= first.rounding + second.rounding:
        return _with_proof(found, found.verdict != "mirror_image", "their periods agree to rounding")
    if any(known):
        return found
    is_achiral = first.genus == 0 and first.boundary_count <= LOOPS_OF_ACHIRAL_SURFACES
    signs = {"indistinguishable": (1, -1) if is_achiral else (1,), "mirror_image": (-1,)}
    for sign in signs.get(found.verdict, (1, -1)):
        similar = _native.similarity(first._native, second._native, sign, progress)
        if similar is None:
            continue
        nearest = replace(found, tolerance=min(found.tolerance, similar.dilatation))
        # Beyond, narrower bounds might tell the surfaces apart.
        if similar.is_exact and similar.dilatation <= ROUNDING:
            if found.verdict == "undecided":  # its matrix may have the other sign
                nearest = replace(nearest, matrix=None, residual=math.inf)
            return _with_proof(nearest, sign > 0 or is_achiral, "their triangles are similar, to rounding")
        if found.verdict in AGREEING and math.isfinite(nearest.tolerance):
            return replace(nearest, sentence=_sentence(nearest))
    return found


def _with_proof(found, is_same, reason):
    verdict, begin = ("equivalent", "Equivalent") if is_same else ("mirror_image", "Mirror images of each other")
    return replace(found, verdict=verdict, sentence=f"{begin}: {reason}.", is_proven=True)


def _sentence(found, is_complete=True, is_bounded=True):
    if found.verdict == "not_equivalent":
        if not found.margin:  # its search came to no end
            return "Not equivalent: no integer matrix takes the periods of one to those of the other."
        return (
            f"Not equivalent: every map stretches some direction at least {_percent(found.margin, math.floor)} more "
            "than another."
        )
    agree = f"their periods differ by {_percent(found.residual)}"
    if found.verdict in AGREEING:
        begin = "Indistinguishable" if found.verdict == "indistinguishable" else "Mirror images"
        if not is_bounded:
            return f"{begin}, but without a bound, since a surface has degenerate triangles: {agree}."
        return f"{begin} within {_percent(found.tolerance)}: {agree}."
    if not is_bounded:
        return "Undecided: a surface has degenerate triangles, so the bounds hold for a slightly different one."
    if not is_complete:
        return f"Undecided: the search among integer matrices reached its limit of {STEPS} steps."
    bound = f"with an error certainly below {_percent(found.tolerance)}"
    return f"Undecided: {agree}, {bound}; narrower `bounds` may tell."


def _percent(distance, rounding=math.ceil):
    """A logarithm as per cent, rounded to two digits."""
    value = 100 * math.expm1(distance)
    return f"{_rounded(value, rounding):.12g} %"


def _rounded(value, rounding):
    if value == 0 or not math.isfinite(value):
        return value
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return rounding(value / unit) * unit


def planar_verdict(a, b, matrix):
    """ "indistinguishable", "mirror_image" or "undecided", of structures whose Dirichlet forms correspond by `matrix`.

    At corresponding points the holomorphic forms have proportional values, at those of a mirror image conjugate ones
    (the canonical map): measured, not bounded."""
    whitened = np.linalg.inv(np.linalg.cholesky(b.projected_gram_matrices[1]))
    first, second = _values(a, whitened @ matrix), _values(b, whitened)
    first = first[np.linspace(0, len(first) - 1, SAMPLES).astype(int)]
    same, mirrored = (_miss(values, second) for values in (first, first.conj()))
    if max(same, mirrored) < ALIKE or CLEARLY * same < mirrored:
        return "indistinguishable"
    return "mirror_image" if CLEARLY * mirrored < same else "undecided"


def _values(structure, matrix):
    """(k, n) unit vectors: the holomorphic forms whose real parts are the Dirichlet forms, in each triangle but those
    where all are 0, for all corners lie on one boundary loop."""
    slopes = _native.form_slopes(structure._triangulation, np.ascontiguousarray(structure.dirichlet_forms))
    values = (slopes @ np.array([1, -1j])) @ matrix.T
    norms = np.linalg.norm(values, axis=1, keepdims=True)
    has_value = norms[:, 0] > 0
    return values[has_value] / norms[has_value]


def _miss(values, others):
    """The mean, over `values`, of the sine of the angle to the nearest of `others`, as complex lines."""
    likeness = np.abs(others.conj() @ values.T).max(axis=0)
    return float(np.sqrt(np.maximum(0, 1 - likeness**2)).mean())


class KnownPeriods:
    """The closed surfaces with a period matrix. It is as exact as its `error` says, at most to rounding; one without is
    as symmetric as it is exact."""

    boundary_count = 0

    def __init__(self, period_matrix):
        omega = checked_period_matrix(period_matrix)
        unit = np.finfo(float).eps / 2
        change = np.abs(np.asarray(period_matrix) - omega) + 2 * len(omega) * unit * np.abs(omega)
        self.period_matrix: Complexes = arrays.frozen(omega)
        self.error = getattr(period_matrix, "error", 0.0) + distance_within(omega, change)
        # Half a unit in the last place of each entry, and the error of a distance that is measured.
        self.rounding = distance_within(omega, unit * np.abs(omega)) + len(omega) * unit
        self.is_exact = self.error <= 2 * len(omega) * self.rounding
        self.genus = len(omega)
        widths = np.exp([-self.error, self.error])
        self.period_bounds = widths[0] * omega.imag, widths[1] * omega.imag
        self._topology = _native.TopologicalType(self.genus, 0)

    def lattice(self):
        """The lattice in the classes dual to the canonical basis; the first g are dual to the a_i."""
        real, imaginary = self.period_matrix.real, self.period_matrix.imag
        inverse = np.linalg.inv(imaginary)
        gram = np.block([[imaginary + real @ inverse @ real, -real @ inverse], [-inverse @ real, inverse]])
        one, none = np.eye(self.genus, dtype=np.int64), np.zeros((self.genus, self.genus), np.int64)
        upper = np.exp(self.error) * (gram + gram.T) / 2
        return _native.PeriodLattice.closed(upper, np.block([[none, one], [-one, none]]))


def period_lattice(structure):
    """The native lattice of integer classes with their energies: of a closed structure, of one with boundary, of
    `KnownPeriods`."""
    if isinstance(structure, KnownPeriods):
        return structure.lattice()
    gram = structure._native.certain_gram_matrices()
    if isinstance(structure, BoundedStructure):
        return _native.PeriodLattice.bounded(*gram, structure.pairing, structure._component.genus)
    wedge = -np.rint(np.linalg.inv(structure.intersection_matrix)).astype(np.int64)
    return _native.PeriodLattice.closed(gram[0], wedge)


def side_of(given):
    """The connected surface, or `KnownPeriods`, of what is to be compared."""
    if isinstance(given, (Surface, Structure)):
        return only_component(given.surface if isinstance(given, Structure) else given)
    try:
        is_numeric = np.asarray(given).dtype.kind in "iufc"
    except ValueError:  # rows of different lengths
        is_numeric = False
    if not is_numeric:
        raise TypeError(f"surfaces, structures or period matrices are compared, not {type(given).__name__}")
    return KnownPeriods(given)
