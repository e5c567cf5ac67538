"""Bounds as narrow as asked for: forms by elements of higher order on a surface refined inside, until they are."""

from dataclasses import dataclass

import numpy as np

from .. import _native
from .._native import SolverError
from ..core.value import Value, counted
from .certificate import OPEN, relative_width
from .refined_triangles import CUT, Triangles, corner_angles, halved, with_layers, worst

MOST_ORDER = 10
MOST_LEVELS = 20
FALL = 0.12  # part of the gaps that the next order leaves where forms are smooth
HALVED = 0.8  # part of the gaps that the triangles have whose sides are halved, where no order is enough
ROUNDING = 0.1  # gaps that add up to less of the bounds' part leave it to rounding
CLEARLY = 2.0  # times the width: energies of a coarse level tell what rounding costs within this factor
ENOUGH = 0.8  # of the width asked for: what a level aims at
SMOOTH = 1e-6  # by what the exponent of a form at a vertex may differ from an integer, and count as one
MOST_BYTES = 8e9  # of a level, where no limit is set
FULL = "the next level would take more memory than memory_limit, or 8 GB"
TINY = 1e-74  # the shortest side
REACHED = "the bounds are as narrow as asked for"


@dataclass(frozen=True, repr=False)
class Refinement(Value):
    """How the bounds of a result were narrowed.

    Attributes
    ----------
    reached : whether they are as narrow as asked for
    reason : why the refinement ended, one sentence
    levels : (triangles, relative width) of each triangulation that was solved on, the surface's own first; never wider,
        and infinite where there are no bounds
    orders : of the polynomials on their triangles; 1, linear functions, on the surface's own
    """

    reached: bool
    reason: str
    levels: tuple[tuple[int, float], ...]
    orders: tuple[int, ...]

    @property
    def has_bounds(self) -> bool:
        """Whether there are any in the end."""
        return bool(np.isfinite(self.levels[-1][1]))

    def _facts(self):
        widths = [f"relative width {width:.2g} on {count} triangles" for count, width in self.levels[-1:]]
        return [counted(len(self.levels), "level"), *widths, f"order {self.orders[-1]}", self.reason]


def narrow(native, width, most_faces, threads, memory_limit, progress=None):
    """Narrows the bounds of a native structure, whose forms are kept, to the relative width, and returns `Refinement`.

    Each level is solved on the Delaunay triangulation of the surface's metric, which is flat inside triangles. What its
    bounds lose is a sum over triangles. From those at vertices where forms are not smooth, corners are cut off, in
    layers; for the others the order is raised. The classes of the forms are carried along as integers, so that all
    levels have the same basis.
    """
    natural = native.families().natural
    surface, classes = native.surface(), native.side_classes()
    levels, orders = [(len(surface.triangles), _width(native))], [1]

    def fits(count, order):
        return _native.element_bytes(count, order, native.families().count) <= (memory_limit or MOST_BYTES)

    order = next((p for p in _first_orders(_width(native), width) if fits(levels[0][0], p)), 0)
    reason = REACHED if levels[0][1] <= width else "" if order else FULL
    while not reason:
        try:
            stage = _stage(progress, levels)
            solved = _native.solve_level(surface, classes, natural, order, threads, stage)
            rounding = float(solved.errors.max())
            if solved.mollification or rounding >= OPEN:
                raise SolverError("triangles are too thin for bounds that are certain")
            of_rounding = _width_of_rounding(solved.energies)
            _take_narrower(native, solved.energies, rounding)
        except SolverError as error:  # the bounds of the levels before hold
            reason = str(error)
            break
        triangles = triangles_of_level(solved)
        levels.append((len(triangles.corners), _width(native)))
        orders.append(order)
        lost = float(solved.gaps.sum())
        reason = _ended(levels, lost, of_rounding, width)
        if reason:
            break
        # Gaps add up to the trace of what the width is the largest eigenvalue of.
        goal = ENOUGH * width * lost / levels[-1][1]
        order, layers, worst_triangles = _next(triangles, solved.gaps, order, goal, fits)
        triangles = halved(triangles, worst_triangles)
        count = count_with_layers(triangles, layers)
        if count > most_faces:
            reason = f"the next level would have {count} triangles, more than {most_faces}"
        elif not fits(count, order):
            reason = FULL
        elif (layers > _deepest(triangles, len(layers))).any():
            reason = "at the largest cone angle, triangles would have to be smaller than numbers can be"
        else:
            surface, classes = surface_of_triangles(with_layers(triangles, layers))
    return Refinement(levels[-1][1] <= width, reason, tuple(levels), tuple(orders))


def _width(native):
    """Infinite where there are no bounds."""
    if native.mollification() or native.metric_error() >= OPEN:
        return np.inf
    return relative_width(*native.period_bounds(), native.period_matrix().imag)


def _part(width):
    """1 - lower / upper of bounds whose difference is `width` times their geometric mean: at most 1, as gaps are."""
    root = (width + np.hypot(width, 2)) / 2 if np.isfinite(width) else np.inf
    return 1 - root**-2.0


def _width_of_rounding(energies):
    """What the width would be if the forms were exact: energies, and so the bounds above and below, are known to the
    part by which rounding may have changed them."""
    parts = [relative_width(gram, certain, gram) for gram, certain in zip(energies.gram, energies.certain, strict=True)]
    return float(sum(parts) if len(parts) > 1 else 2 * parts[0])


def _first_orders(found, asked):
    return range(2 + (asked < 1e-2 * found) + (asked < 1e-4 * found), 1, -1)


def _take_narrower(native, energies, rounding):
    """Gives the structure these energies, unless its own ones bound it better."""
    before = _width(native), native.gram_matrices(), native.certain_gram_matrices(), native.metric_error()
    native.narrow(energies.gram, energies.certain, metric_error=rounding)
    if not _width(native) <= before[0]:
        native.narrow(list(before[1]), list(before[2]), metric_error=before[3])


def _ended(levels, lost, of_rounding, width):
    """Why the refinement ends at the last level; "" where it goes on."""
    if levels[-1][1] <= width:
        return REACHED
    if of_rounding > CLEARLY * width or lost < ROUNDING * _part(levels[-1][1]):
        return "rounding keeps the bounds from getting narrower"
    return f"{MOST_LEVELS} levels were solved" if len(levels) == MOST_LEVELS else ""


def _next(triangles, gaps, order, goal, fits):
    """(order, layers at each vertex, triangles to halve) of the cheapest level whose gaps should be as small as `goal`:
    an order that is enough where forms are smooth, layers that are where they are not. Where none fits into memory,
    `order` remains, with as many layers as should make the gaps a third."""
    exponents = vertex_exponents(triangles)
    roughness = np.abs(exponents - np.round(exponents))
    roughness[roughness <= SMOOTH] = 0
    # The energy of what is not smooth in r^(1 + d) is about d^2.
    shares = roughness[triangles.corners] ** 2
    total = shares.sum(axis=1)
    smooth = float(gaps[total == 0].sum())
    shares *= (gaps / np.where(total > 0, total, 1))[:, None]
    at_vertices = np.bincount(triangles.corners.ravel(), shares.ravel(), minlength=len(exponents))
    best, chosen = np.inf, (order, _layers(at_vertices, exponents, float(gaps.sum()) / 3))
    for p in range(order, MOST_ORDER + 1):
        # Where a form is like r^a, polynomials of degree p miss its energy by p^(-4 a).
        layers = _layers(at_vertices * (order / p) ** (4 * exponents), exponents, goal / 2)
        count = count_with_layers(triangles, layers)
        cost = count * p**3
        is_enough = smooth * FALL ** (p - order) <= goal / 2
        if (is_enough or p == MOST_ORDER) and cost < best and fits(count, p):
            best, chosen = cost, (p, layers)
    to_halve = np.zeros(len(gaps), bool)
    if chosen[0] == order and not chosen[1].any():
        if order < MOST_ORDER:
            return order + 1, chosen[1], to_halve
        # Halved, a triangle loses nearly all of its gap at this order.
        at_smooth = np.where(total == 0, gaps, 0)
        to_halve = worst(at_smooth, 1 - goal / 2 / smooth) if smooth > goal / 2 else worst(gaps, HALVED)
    return *chosen, to_halve


def count_with_layers(triangles, layers):
    """How many triangles there are with these layers: each has two at a corner."""
    if not layers.any():  # new vertices have none
        return len(triangles.corners)
    return len(triangles.corners) + 2 * int(layers[triangles.corners].sum())


def _deepest(triangles, count):
    """(count,) how many layers there may be at each vertex for squares of areas not to vanish."""
    shortest = np.full(triangles.corners.max() + 1, np.inf)
    for sides in (triangles.sides, np.roll(triangles.sides, 1, axis=1)):
        np.minimum.at(shortest, triangles.corners, sides)
    return np.floor(np.log(shortest[:count] / TINY) / np.log(1 / CUT))


def _layers(losses, exponents, goal):
    """How often the corners at vertices are to be cut off, so that their losses add up to `goal`: those of r^a in a
    triangle that is `CUT` as large are CUT^(2 a) as large."""
    ascending = np.sort(losses)
    after = np.arange(len(losses), 0, -1) * ascending  # what is left if none is more than this one
    total = np.concatenate([[0], np.cumsum(ascending)[:-1]]) + after
    first = int(np.searchsorted(total, goal))
    if first == len(losses):
        return np.zeros(len(losses), int)
    most = (goal - np.concatenate([[0], np.cumsum(ascending)])[first]) / (len(losses) - first)
    with np.errstate(divide="ignore"):
        wanted = np.log(np.maximum(losses / most, 1)) / (2 * exponents * np.log(1 / CUT))
    return np.ceil(wanted).astype(int)


def vertex_exponents(triangles):
    """(#V,) the least a > 0 with a form like d r^a at the vertex: 2 pi over the angle around it, on the boundary pi."""
    corners = triangles.corners
    angles = np.bincount(corners.ravel(), corner_angles(triangles.sides).ravel())
    is_boundary = np.bincount(triangles.edges.ravel())[triangles.edges] == 1
    half = np.zeros(len(angles), bool)
    half[corners[is_boundary]] = True
    return np.where(half, np.pi, 2 * np.pi) / angles


def triangles_of_level(solved):
    """`Triangles` of a native level."""
    classes = solved.classes.reshape(len(solved.triangles), 3, -1)
    return Triangles(solved.triangles, solved.triangle_edges, solved.lengths, solved.errors, classes)


def surface_of_triangles(triangles):
    """The native surface, and the classes on its sides. Entry i of names and lengths lies opposite corner i there."""
    opposite = [1, 2, 0]
    corners = triangles.corners.astype(np.int64)
    names = triangles.edges[:, opposite].astype(np.int64)
    sides = triangles.sides[:, opposite]
    surface = _native.refined_surface(int(corners.max()) + 1, corners, sides, names, triangles.errors)
    return surface, np.ascontiguousarray(triangles.classes.reshape(len(corners), -1), np.int32)


def _stage(progress, levels):
    if progress is None:
        return None
    return lambda fraction, stage: progress(fraction, f"level {len(levels) + 1}: {stage}")
