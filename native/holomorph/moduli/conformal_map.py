"""The conformal map between two equivalent surfaces, by matching their forms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._native import SolverError, TopologyError
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.progress import scaled
from ..core.value import Value, counted
from ..forms.refined_triangles import areas
from ..forms.structure import BoundedStructure, ConformalStructure
from ..mesh.checks import checked_uv
from ..mesh.surface import Surface
from ..mesh.surgery import double_cover
from .equivalence import AGREEING, Equivalence, by_topology, checked_tolerance, compared, side_of

STARTS = 12  # points of the second surface that are tried for one of the first
SAMPLES = 16  # points of the first surface that are tried
TRIED = 400  # vertices that tell most wrong starts from right ones
FINALISTS = 16  # starts that are tried farther, half of them each time
FARTHER = 4  # times as many vertices each time
ALIKE = 0.98  # cosine of the forms' values at two points that are taken for one start
ROUNDS = 4  # times that the start is corrected
MOST_RESIDUAL = 0.05  # largest residual of a map that is one
SEARCH = (0.2, 0.3, 0.4)  # parts of the work: the verdict, starts, the best of them
FOUND = 0.9  # part of the work after which the map is there

Mapped = ConformalStructure | BoundedStructure


@dataclass(frozen=True, eq=False, repr=False)
class ConformalMap(Value):
    """A conformal map from one surface to another, at the vertices of the first.

    triangles : (#V,) triangle of the second surface in which the image lies, -1 at isolated vertices
    barycentric : (#V, 3) its coordinates there
    residual : an estimate of its error: root mean square distance of the images from where a conformal map takes the
        vertices, in units where the integral of the forms over a closed loop is about 1. Of the forms' integrals, which
        differ at corresponding points, and of the triangles' images, which are not similar to them;
        `Equivalence.residual` where that is larger. Where the map is known it is 0.4 to 2 times the error
    folded : (k,) triangles of the first surface whose images face the other way than the others do
    equivalence : the `Equivalence` that it is made of
    """

    triangles: Integers
    barycentric: Reals
    residual: float
    folded: Integers
    equivalence: Equivalence
    _surfaces: tuple[Surface, Surface]
    _corners: Integers

    def _facts(self):
        folded = [f"{len(self.folded)} folded"] if len(self.folded) else []
        return [counted(len(self.triangles), "image"), f"residual {self.residual:.2g}", *folded]

    def of(self, values: ArrayLike) -> NDArray[Any]:
        """(#V, ...) values on the first surface of (#V', ...) values at the vertices of the second: its positions give
        the images."""
        values = np.asarray(values)
        return np.einsum("vi,vi...->v...", self.barycentric, values[self._corners[self.triangles]])

    def uv(self, uv: ArrayLike, progress: Progress | None = None) -> Reals:
        """(#C, 2) UVs at the polygon corners of the first surface of (#C', 2) `uv` at those of the second: its texture,
        carried over. The corners of one polygon are in one chart, that of the polygon's middle, which is continued
        across its cuts: a texture that goes on there, as that of a map by forms does, goes on here.

        Raises ValueError for another shape or numbers that are not finite; Cancelled. Cost: linear."""
        first, second = self._surfaces
        uv = checked_uv(uv, second, is_finite=True)
        return _native.carried_uv(first._native, self.triangles, self.barycentric, second._native, uv, progress)


def conformal_map(a: Mapped, b: Mapped, *, tolerance: float = 0.0, progress: Progress | None = None) -> ConformalMap:
    """The `ConformalMap` from structure `a` to structure `b`, closed of genus >= 1 or with boundary, which are
    not told apart by the bounds that they have, or mirror images: then it reverses the orientation. `tolerance` as in
    `conformally_equivalent`.

    The integrals of forms that correspond by `Equivalence.matrix` are the same at corresponding points. The map begins
    at a point where the values of all forms agree best, on the boundary if there is one, and goes on along the edges of
    `a`.

    Raises TypeError for other structures; TopologyError where the surfaces differ, or may differ;
    SolverError where no start leads to a map; Cancelled.

    Cost: linear in both surfaces, beside that of `conformally_equivalent`.
    Source: Torelli's theorem; the search for corresponding points is ours, docs/method/equivalence.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> moved = holomorph.Surface.from_polygons(2 * surface.vertices, surface.corner_vertices, surface.face_offsets)
    >>> a, b = holomorph.conformal_structure(surface), holomorph.conformal_structure(moved)
    >>> found = holomorph.conformal_map(a, b)
    >>> print(np.allclose(found.of(moved.vertices), 2 * surface.vertices))
    True
    """
    for structure in (a, b):
        if not isinstance(structure, Mapped):
            raise TypeError(f"a map needs structures with forms and without poles, not a {type(structure).__name__}")
    known = by_topology(*(side_of(structure) for structure in (a, b)))
    found = known or compared([a, b], checked_tolerance(tolerance), scaled(progress, 0.0, 0.2))
    if found.verdict not in AGREEING or found.matrix is None:
        raise TopologyError(f"no map can be made; {found.sentence}")
    matching = _Matching(sides(a, b, found), found.verdict == "mirror_image", progress)
    return _result(a, b, matching, found, scaled(progress, FOUND, 1.0))


class _Matching:
    def __init__(self, both, is_mirror_image, progress):
        self._sides, self._is_mirror_image, self._progress = both, is_mirror_image, progress
        first, second = both
        self._slopes = [_native.form_slopes(side.surface, side.forms) for side in both]  # (#T, n, 2)
        self._continuations = {
            sign: _native.Continuation(first.surface, sign * first.forms, second.surface, second.forms)
            for sign in (1, -1)
        }

    def run(self):
        """The native images of the best continuation."""
        sign, start = self._start()
        continuation = self._continuations[sign]
        best, begin = None, SEARCH[2]
        for k in range(ROUNDS):
            step = (FOUND - begin) / ROUNDS
            progress = scaled(self._progress, begin + k * step, begin + (k + 1) * step)
            made = continuation.run(*start, len(self._sides[0].surface.edges), progress)
            if best is not None and _size(made) >= _size(best):
                break
            best = made
            vertex, triangle, residual = start
            start = vertex, triangle, residual - self._shift(made)
        return best

    def densities(self, triangles):
        """(k,) by how much the forms' integrals change along a unit step in triangles of the second side."""
        return np.sqrt((self._slopes[1][triangles] ** 2).sum(axis=(1, 2)) / 2)

    def _start(self):
        """Sign and start that fit best. On a thin arm all forms are nearly proportional, and wrong starts fit there as
        well as right ones, until the continuation leaves the arm."""
        fit = itemgetter(0)
        found, most = sorted(self._tried(), key=fit)[:FINALISTS], TRIED
        parts = iter(np.linspace(*SEARCH[1:], 2 * len(found)))
        while len(found) > 1:
            most *= FARTHER
            again = [(self._misfit(sign, start, most, next(parts)), sign, start) for _, sign, start in found]
            found = sorted(again, key=fit)[: len(found) // 2]
        return found[0][1:]

    def _misfit(self, sign, start, most, part):
        """Infinite where the map goes to the reflected copy of the second surface: back on the surface, it would keep
        no orientation. `part` of the whole work is done."""
        made = self._continuations[sign].run(*start, most, scaled(self._progress, part, part))
        is_reflected = np.mean(made.triangles >= self._sides[1].own_count) > 0.5
        return math.inf if is_reflected else _size(made)

    def _tried(self):
        """(size of the residuals, sign, start) of the first vertices from each start."""
        first, second = self._sides
        unit = [self._unit_values(i) for i in range(2)]
        if self._is_mirror_image:
            unit[0] = unit[0].conj()
        for k, s in enumerate(np.linspace(0, len(unit[0]) - 1, SAMPLES).astype(int)):
            likeness = np.abs(unit[1] @ unit[0][s].conj())
            for i in range(STARTS):
                part = SEARCH[0] + (SEARCH[1] - SEARCH[0]) * (k + i / STARTS) / SAMPLES
                t = int(np.argmax(likeness))
                likeness[np.abs(unit[1] @ unit[1][t].conj()) > ALIKE] = -1
                triangle, corner = second.starts[t]
                start = int(first.vertices[s]), int(triangle), second.residual(triangle, corner)
                for sign in self._continuations:
                    yield self._misfit(sign, start, TRIED, part), sign, start
                if likeness.max() < 0:
                    break

    def _unit_values(self, i):
        """(k, n) unit vectors: the forms' complex values at the starts of a side."""
        values = self._slopes[i][self._sides[i].starts[:, 0]] @ np.array([1, -1j])
        return values / np.linalg.norm(values, axis=1, keepdims=True)

    def _shift(self, made):
        """The correction of the integrals of the start: the shift in which the residuals agree, as far as moves of the
        images cannot remove it.
        """
        residuals, slopes = made.residuals, self._slopes[1][made.triangles]
        n = residuals.shape[1]
        if n == 2:
            return np.zeros(2)
        projectors = np.eye(n) - slopes @ np.linalg.pinv(slopes)
        return np.linalg.solve(projectors.mean(axis=0), residuals.mean(axis=0))


def _result(a, b, matching, found, progress):
    made = matching.run()
    mismatch = math.sqrt(_size(made))
    if mismatch > MOST_RESIDUAL:
        raise SolverError(
            f"no map was found: the forms' integrals still differ by {mismatch:.2g} where the search ended"
        )
    # What lies beyond the boundary, in the other copy of the double, is reflected.
    first, second = a._triangulation, b._triangulation
    count = len(second.triangles)
    is_beyond = made.triangles >= count
    triangles, barycentric = np.full(first.vertex_count, -1, np.int32), np.full((first.vertex_count, 3), np.nan)
    triangles[made.vertices] = np.where(is_beyond, made.triangles - count, made.triangles)
    barycentric[made.vertices] = np.where(is_beyond[:, None], made.barycentric[:, [0, 2, 1]], made.barycentric)
    sign = -1 if found.verdict == "mirror_image" else 1
    p, q = (np.abs(z) for z in _native.map_derivatives(first, triangles, barycentric, second, sign, progress))
    is_folded = ~(q < p)
    # What is not similar in the image of a triangle, in the metric of the forms.
    sizes = np.sqrt(areas(first.edge_lengths[first.triangle_edges])) * matching.densities(
        triangles[first.triangles[:, 0]]
    )
    stretch = math.sqrt(np.mean((q * sizes)[~is_folded] ** 2))
    residual = max(math.hypot(mismatch, stretch), found.residual)
    folded = np.flatnonzero(is_folded).astype(np.int32)
    corners, surfaces = b._of_surface(second.triangles), (a.surface, b.surface)
    images = a._at_vertices(arrays.frozen(triangles), -1), a._at_vertices(arrays.frozen(barycentric))
    return ConformalMap(*images, residual, arrays.frozen(folded), found, surfaces, corners)


def _size(made):
    return float((made.residuals**2).sum(axis=1).mean())


@dataclass(frozen=True, eq=False)
class Side:
    """surface : native triangulation; forms : (n, #E); starts : (k, 2) triangle and corner at which maps may begin;
    is_at_corner : whether they begin there exactly, as on a boundary, or in the triangle's middle; own_count : how many
    of its triangles, the first, are the surface's own: on a double the others are their reflections"""

    surface: _native.Surface
    forms: Reals
    starts: Integers
    is_at_corner: bool
    own_count: int

    @property
    def vertices(self):
        """(k,) of the starts."""
        return self.surface.triangles[self.starts[:, 0], self.starts[:, 1]]

    def residual(self, triangle, corner):
        """(n,) minus the integrals from the start to the middle of its triangle."""
        if not self.is_at_corner:
            return np.zeros(len(self.forms))
        along = _along_sides(self.surface, self.forms[:, self.surface.triangle_edges[[triangle]]], [triangle])[:, 0]
        return (along[:, corner - 1] - along[:, corner]) / 3


def sides(a, b, found):
    """Both sides of a map from structure `a` to `b`, whose classes correspond by the `Equivalence`. The boundary of `b`
    is no obstacle: its side is the double, whose first triangles are those of the surface."""
    if isinstance(a, BoundedStructure):
        return _bounded_sides(a, b, found)
    whiten = np.linalg.inv(np.linalg.cholesky(b._native.natural_gram()))
    forms = whiten @ found.matrix @ a.harmonic_forms, whiten @ b.harmonic_forms
    return tuple(_closed_side(structure, values) for structure, values in zip((a, b), forms))


def _closed_side(structure, forms):
    surface = structure._triangulation
    everywhere = np.stack([np.arange(len(surface.triangles)), np.zeros(len(surface.triangles), int)], axis=1)
    return Side(surface, forms, everywhere, is_at_corner=False, own_count=len(surface.triangles))


def _bounded_sides(a, b, found):
    """The forms are the Dirichlet ones and their conjugates, symmetric on the double, which a reflection reverses."""
    whiten = np.linalg.inv(np.linalg.cholesky(b.projected_gram_matrices[1]))
    sign = -1 if found.verdict == "mirror_image" else 1
    matrix = whiten @ found.matrix
    forms = np.concatenate([matrix @ a.dirichlet_forms, sign * matrix @ _conjugates(a)])
    first, second = a._triangulation, b._triangulation
    double = double_cover(Surface._of(second))._native
    both = (b.dirichlet_forms, -1), (_conjugates(b), 1)
    parts = [_on_double(second, double, whiten @ values, parity) for values, parity in both]
    return _bounded_side(first, first, forms), _bounded_side(double, second, np.concatenate(parts))


def _bounded_side(surface, own, forms):
    return Side(surface, forms, _boundary_sides(own), is_at_corner=True, own_count=len(own.triangles))


def _conjugates(structure):
    return -np.linalg.solve(structure.star, structure.natural_forms)


def _boundary_sides(surface):
    """(k, 2) triangle and side."""
    on_boundary = np.bincount(surface.triangle_edges.ravel(), minlength=len(surface.edges)) == 1
    return np.argwhere(on_boundary[surface.triangle_edges])


def _along_sides(surface, values, triangles=slice(None)):
    """The values on edges along the sides, of which none is a loop."""
    corners = surface.triangles[triangles]
    return values * np.where(corners < np.roll(corners, -1, axis=1), 1, -1)


def _on_double(surface, double, forms, parity):
    """(n, #E of the double): the same on dual edges, or the negative where `parity` is -1. Side 2 - k of a triangle in
    the second copy lies over side k, and runs backwards."""
    along = _along_sides(surface, forms[:, surface.triangle_edges])
    both = np.concatenate([along, -parity * along[:, :, ::-1]], axis=1)
    result = np.empty((len(forms), len(double.edges)))
    result[:, double.triangle_edges] = _along_sides(double, both)
    return result
