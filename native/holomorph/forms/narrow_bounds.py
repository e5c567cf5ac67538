"""Bounds as narrow as asked for: the surface refined inside, by intrinsic triangles, until they are."""

from dataclasses import dataclass

import numpy as np

from .. import _native
from ..core.value import Value, counted
from .certificate import OPEN, relative_width
from .refined_triangles import Triangles, gaps, refined, worst

PART = 0.05, 0.4  # least and largest part of all gaps between energies that the marked triangles have
QUARTERED = 0.75  # part of its gap that a triangle loses when it is cut in four, where forms are smooth
MOST_LEVELS = 60
LEAST_GAIN = 1e-3  # a level that narrows the bounds by a smaller part is the last: rounding is reached


@dataclass(frozen=True, repr=False)
class Refinement(Value):
    """How the bounds of a result were narrowed.

    Attributes
    ----------
    reached : whether they are as narrow as asked for
    reason : why the refinement ended, one sentence
    levels : (triangles, relative width) of each triangulation, the surface's own first; nested, so never wider
    """

    reached: bool
    reason: str
    levels: tuple[tuple[int, float], ...]

    def _facts(self):
        widths = [f"relative width {width:.2g} on {count} triangles" for count, width in self.levels[-1:]]
        return [counted(len(self.levels), "level"), *widths, self.reason]


def narrow(native, width, most_faces, solver, threads, memory_limit, progress=None, uniform=False):
    """Narrows the bounds of a native structure, whose forms are kept, to the relative width, and returns `Refinement`.

    Each level is solved on the Delaunay triangulation of the surface's metric, then cut where the two energies are
    farthest apart (`uniform`: everywhere). The classes of the forms are carried along as integers, so all levels have
    the same basis.
    """
    natural = native.families().natural
    surface, classes = native.surface(), native.side_classes()
    levels = []
    while True:
        stage = _stage(progress, levels)
        solved = _native.solve_level(surface, classes, natural, solver, threads, memory_limit, stage)
        triangles = _triangles(solved)
        rounding = float(triangles.errors.max())
        if solved.mollification or rounding >= OPEN:
            reason = "triangles are too thin for bounds that are certain"
            break
        native.narrow(solved.energies.gram, solved.energies.certain, metric_error=rounding)
        levels.append((len(triangles.corners), relative_width(*native.period_bounds(), native.period_matrix().imag)))
        reason = _ended(levels, width)
        if reason:
            break
        everywhere = np.ones(len(triangles.corners), dtype=bool)
        part = np.clip((1 - width / levels[-1][1]) / QUARTERED, *PART)  # the last level is hardly finer than asked for
        pieces = refined(triangles, everywhere if uniform else worst(gaps(triangles, solved.functions, natural), part))
        if len(pieces.corners) > most_faces:
            reason = f"the next level would have {len(pieces.corners)} triangles, more than {most_faces}"
            break
        surface, classes = _surface(pieces)
    return Refinement(bool(levels) and levels[-1][1] <= width, reason, tuple(levels))


def _ended(levels, width):
    """Why the refinement ends at the last level; "" where it goes on."""
    if levels[-1][1] <= width:
        return "the bounds are as narrow as asked for"
    if len(levels) > 1 and levels[-1][1] > (1 - LEAST_GAIN) * levels[-2][1]:
        return "rounding keeps the bounds from getting narrower"
    return f"{MOST_LEVELS} levels were solved" if len(levels) == MOST_LEVELS else ""


def _triangles(solved):
    """`Triangles` of a native level."""
    classes = solved.classes.reshape(len(solved.triangles), 3, -1)
    return Triangles(solved.triangles, solved.triangle_edges, solved.lengths, solved.errors, classes)


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
