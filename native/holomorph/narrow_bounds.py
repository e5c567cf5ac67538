"""Bounds as narrow as asked for: the surface refined inside, by intrinsic triangles, until they are."""

from dataclasses import dataclass

import numpy as np

from . import _native
from .certificate import OPEN, relative_width
from .refined_triangles import Triangles, gaps, refined, worst

PART = 0.6  # of all gaps between the energies that triangles marked for refinement have
MOST_LEVELS = 60
LEAST_GAIN = 1e-3  # a level that narrows the bounds by a smaller part is the last: rounding is reached


@dataclass(frozen=True)
class Refinement:
    """How the bounds of a result were narrowed.

    Attributes
    ----------
    reached : whether they are as narrow as asked for
    reason : why the refinement ended, one sentence
    levels : (triangles, relative width) of each triangulation, the surface's own first; nested, so never wider
    """

    reached: bool
    reason: str
    levels: tuple


def narrow(native, width, most_faces, solver, threads, memory_limit, progress=None, uniform=False):
    """Narrows the bounds of a native structure, whose forms are kept, to the relative width, and returns `Refinement`.

    Each level is solved on the Delaunay triangulation of the surface's metric, then cut where the two energies are
    farthest apart (`uniform`: everywhere). The classes of the forms are carried along as integers, so all levels have
    the same basis.
    """
    natural = native.families()[0]
    surface, classes = native.surface(), native.side_classes()
    levels, best = [], None
    while True:
        solve = _native.solve_level(surface, classes, natural, solver, threads, memory_limit, _stage(progress, levels))
        triangles, functions, grams, mollification = _level(solve)
        if mollification or triangles.errors.max() >= OPEN:
            return _ended(native, best, levels, width, "triangles are too thin for bounds that are certain")
        best = [*grams, float(triangles.errors.max())]
        native.narrow(*best)
        levels.append((len(triangles.corners), relative_width(*native.period_bounds(), native.period_matrix().imag)))
        if levels[-1][1] <= width:
            return _ended(native, best, levels, width, "the bounds are as narrow as asked for")
        if len(levels) > 1 and levels[-1][1] > (1 - LEAST_GAIN) * levels[-2][1]:
            return _ended(native, best, levels, width, "rounding keeps the bounds from getting narrower")
        marked = np.ones(len(triangles.corners), bool)
        if not uniform:
            marked = worst(gaps(triangles, functions, natural), PART)
        pieces = refined(triangles, marked)
        if len(pieces.corners) > most_faces or len(levels) == MOST_LEVELS:
            reason = f"the next level would have {len(pieces.corners)} triangles, more than {most_faces}"
            return _ended(native, best, levels, width, reason)
        surface, classes = _surface(pieces)


def _ended(native, best, levels, width, reason):
    reached = bool(levels) and levels[-1][1] <= width
    return Refinement(reached, reason, tuple(levels))


def _level(solved):
    corners, edges, lengths, errors, classes, functions, gram, certain, mollification = solved
    classes = classes.reshape(len(corners), 3, -1)
    triangles = Triangles(corners, edges, lengths.ravel(), errors.ravel(), classes)
    return triangles, functions, (gram, certain), mollification


def _surface(pieces):
    """The native surface of some `Pieces`, and the classes on its sides. Entry i of names and lengths lies opposite
    corner i there."""
    opposite = [1, 2, 0]
    corners = pieces.corners.astype(np.int64)
    surface = _native.refined_surface(
        int(corners.max()) + 1, corners, pieces.sides[:, opposite], pieces.names[:, opposite], pieces.errors
    )
    return surface, np.ascontiguousarray(pieces.classes.reshape(len(corners), -1), np.int32)


def _stage(progress, levels):
    if progress is None:
        return None
    return lambda fraction, stage: progress(fraction, f"level {len(levels) + 1}: {stage}")
