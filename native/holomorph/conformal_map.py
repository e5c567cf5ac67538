"""The conformal map between two equivalent closed surfaces, by matching their forms."""

from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native, arrays
from ._native import SolverError, TopologyError
from .array_types import Integers, Progress, Reals
from .closed import ConformalStructure
from .equivalence import Equivalence, conformally_equivalent, scaled
from .value import Value, counted

STARTS = 12  # points of the second surface that are tried for one of the first
SAMPLES = 16  # points of the first surface that are tried
TRIED = 400  # vertices that tell most wrong starts from right ones
FINALISTS = 16  # starts that are tried farther, half of them each time
FARTHER = 4  # times as many vertices each time
ALIKE = 0.98  # cosine of the forms' values at two points that are taken for one start
ROUNDS = 4  # of the correction of the start
MOST_RESIDUAL = 0.05  # of a map that is one


@dataclass(frozen=True, eq=False, repr=False)
class ConformalMap(Value):
    """A conformal map from one surface to another, at the vertices of the first.

    triangles : (#V,) triangle of the second surface in which the image lies, -1 at isolated vertices
    barycentric : (#V, 3) its coordinates there
    residual : root mean square of the difference of the forms' integrals at corresponding points, in units where the
        integral over a closed loop is about 1: an error of the map
    equivalence : the `Equivalence` that it is made of
    """

    triangles: Integers
    barycentric: Reals
    residual: float
    equivalence: Equivalence
    _corners: Integers

    def _facts(self):
        return [counted(len(self.triangles), "image"), f"residual {self.residual:.2g}"]

    def of(self, values: ArrayLike) -> NDArray[Any]:
        """(#V, ...) values on the first surface of (#V', ...) values at the vertices of the second: its positions give
        the images."""
        values = np.asarray(values)
        return np.einsum("vi,vi...->v...", self.barycentric, values[self._corners[self.triangles]])


def conformal_map(
    a: ConformalStructure, b: ConformalStructure, *, tolerance: float = 0.0, progress: Progress | None = None
) -> ConformalMap:
    """The `ConformalMap` from closed structure `a` to closed structure `b`, of genus >= 1, which are equivalent or
    mirror images: then it reverses the orientation. `tolerance` as in `conformally_equivalent`.

    The integrals of forms that correspond by `Equivalence.matrix` are the same at corresponding points. The map begins
    at a point where the values of all forms agree best, and goes on along the edges of `a`.

    Raises TypeError for other structures; TopologyError where the surfaces are not known to be equivalent;
    SolverError where no start leads to a map; Cancelled.

    Cost: linear in both surfaces, beside that of `conformally_equivalent`.
    """
    for structure in (a, b):
        if not isinstance(structure, ConformalStructure):
            raise TypeError(f"maps are made between closed structures, not of a {type(structure).__name__}")
    found = conformally_equivalent(a, b, tolerance=tolerance, progress=scaled(progress, 0.0, 0.2))
    if found.verdict not in ("equivalent", "mirror_image"):
        raise TopologyError(f"there is no map to be made; {found.sentence}")
    gram = b._native.projected()[0]
    whiten = np.linalg.inv(np.linalg.cholesky(gram))
    forms = [whiten @ found.matrix @ a.harmonic_forms, whiten @ b.harmonic_forms]
    return _Matching(a, b, forms, found, progress).run()


class _Matching:
    def __init__(self, a, b, forms, found, progress):
        self._a, self._b, self._forms, self._found, self._progress = a, b, forms, found, progress
        surfaces = a._triangulation, b._triangulation
        self._slopes = [_native.form_slopes(surface, f) for surface, f in zip(surfaces, forms)]  # (#T, n, 2)
        self._continuations = {
            sign: _native.Continuation(surfaces[0], sign * forms[0], surfaces[1], forms[1]) for sign in (1, -1)
        }

    def run(self):
        sign, start = self._start()
        continuation = self._continuations[sign]
        best = None
        for k in range(ROUNDS):
            progress = scaled(self._progress, 0.2 + 0.8 * k / ROUNDS, 0.2 + 0.8 * (k + 1) / ROUNDS)
            made = continuation.run(*start, len(self._a.edges), progress)
            if best is not None and _size(made) >= _size(best):
                break
            best = made
            vertex, triangle, residual = start
            start = vertex, triangle, residual - self._shift(made)
        return self._result(best)

    def _start(self):
        """Sign and start that fit best. On a thin arm all forms are nearly proportional, and wrong starts fit there as
        well as right ones, until the continuation leaves the arm."""
        fit = itemgetter(0)
        found, most = sorted(self._tried(), key=fit)[:FINALISTS], TRIED
        while len(found) > 1:
            most *= FARTHER
            again = [(self._misfit(sign, start, most), sign, start) for _, sign, start in found]
            found = sorted(again, key=fit)[: len(found) // 2]
        return found[0][1:]

    def _misfit(self, sign, start, most):
        return _size(self._continuations[sign].run(*start, most, None))

    def _tried(self):
        """(size of the residuals, sign, start) of the first vertices from each start."""
        values = [slopes @ np.array([1, -1j]) for slopes in self._slopes]
        if self._found.verdict == "mirror_image":
            values[0] = values[0].conj()
        unit = [v / np.linalg.norm(v, axis=1, keepdims=True) for v in values]
        n = len(self._forms[0])
        for s in np.linspace(0, len(unit[0]) - 1, SAMPLES).astype(int):
            likeness = np.abs(unit[1] @ unit[0][s].conj())
            for _ in range(STARTS):
                t = int(np.argmax(likeness))
                likeness[np.abs(unit[1] @ unit[1][t].conj()) > ALIKE] = -1
                for sign in self._continuations:
                    start = int(self._a._triangulation.triangles[s][0]), t, np.zeros(n)
                    yield self._misfit(sign, start, TRIED), sign, start
                if likeness.max() < 0:
                    break

    def _shift(self, made):
        """By how much the integrals of the start are wrong: what the images cannot follow, in the mean."""
        vertices, triangles, _, residuals = made
        slopes = self._slopes[1][triangles]
        n = residuals.shape[1]
        if n == 2:
            return np.zeros(2)
        projectors = np.eye(n) - slopes @ np.linalg.pinv(slopes)
        return np.linalg.solve(projectors.mean(axis=0), residuals.mean(axis=0))

    def _result(self, made):
        vertices, triangles, barycentric, residuals = made
        order = np.argsort(vertices)
        residual = float(np.sqrt((residuals**2).sum(axis=1).mean()))
        if residual > MOST_RESIDUAL:
            raise SolverError(f"no map was found: the forms' integrals differ by {residual:.2g} where it ends")
        component, surface = self._a._component, self._a.surface
        all_triangles = np.full(surface.given_vertex_count, -1)
        all_barycentric = np.full((surface.given_vertex_count, 3), np.nan)
        where = np.arange(len(order)) if component is surface else component.vertex_index
        all_triangles[where], all_barycentric[where] = triangles[order], barycentric[order]
        corners = self._b._of_surface(self._b._triangulation.triangles)
        return ConformalMap(
            arrays.frozen(all_triangles), arrays.frozen(all_barycentric), residual, self._found, corners
        )


def _size(made):
    return float((made[3] ** 2).sum(axis=1).mean())
