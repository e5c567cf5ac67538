"""What the results of all kinds of surfaces have in common, and the reports on their solves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from operator import attrgetter
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.value import Solution, Value, counted
from ..mesh.checks import checked_uv
from ..mesh.surface import Surface
from ..quality.quality import Quality
from ..tiling.request import Poles, Request, asked_turns, part_of
from ..tiling.tiling import Tiler, Tiling


@dataclass(frozen=True, repr=False)
class SolverReport(Value):
    """Which solver was used and why; iterations (of multigrid or, by the paper's solver, on the surface itself; steps
    of iterative refinement of the direct solver); the largest relative residual of the linear systems, or where forms
    were refined, among thin triangles, their largest relative error in energy.

    levels : (faces, iterations, seconds) of the paper's solver on each level of the progressive mesh, the base mesh
        first and the surface last, where the seconds of a level include making its linear system, with boundary that of
        its double; () for other solvers
    """

    name: str
    reason: str
    iterations: int
    residual: float
    levels: tuple[tuple[int, int, float], ...] = ()

    @classmethod
    def of(cls, native: object) -> Self:
        """Makes one of a native report."""
        levels = tuple((level.faces, level.iterations, level.seconds) for level in native.levels)
        return cls(native.name, native.reason, native.iterations, native.residual, levels)

    def _facts(self):
        return [self.name, self.reason, counted(self.iterations, "iteration"), f"residual {self.residual:.2g}"]


@dataclass(frozen=True)
class Residuals:
    """Relative maxima over all harmonic forms, on the intrinsic triangulation that was solved on.

    closedness: sum around a face over the largest value of the form; harmonicity: sum of k h at a vertex over the
    largest sum of |k h|; periods: difference of the integral of h_j over zeta_i from delta_ij.
    """

    closedness: float
    harmonicity: float
    periods: float


@dataclass(frozen=True)
class ClosedResiduals(Residuals):
    """And asymmetry: largest difference between the Gram matrix and its transpose, before it was made symmetric, over
    its largest entry, where the forms were not kept; else 0."""

    asymmetry: float


@dataclass(frozen=True)
class MemoryPlan:
    """How a computation keeps within `memory_limit`. keeps_forms: all harmonic functions are kept in memory, else each
    block of forms is freed once measured; block: right-hand sides solved for at a time; bytes: estimate of the most
    memory in use at once, without the surface itself; not less than what was measured, and up to 2.5 times that, 30 MB
    more of small surfaces."""

    keeps_forms: bool
    block: int
    bytes: int


@dataclass(frozen=True)
class BoundedResiduals(Residuals):
    """Those of both families; harmonicity at every vertex for the natural forms, at the inner ones for the Dirichlet
    forms; periods of the natural forms. pairing: largest difference of the integral of h^N_i ^ h from what the integers
    W say, for one h = sum of +-h^D_j."""

    pairing: float


@dataclass(frozen=True, eq=False, repr=False)
class Structure(Value):
    """Base of the results of `conformal_structure`. All arrays are read-only; the large ones are computed when first
    used. Each kind of result adds its forms, its invariants and

    uv(coefficients) : (#C, 2) UVs of a combination of `holomorphic_forms`, without a solve
    balanced_coefficients() : those of the map that is shown first
    form_count, coefficient_type : number and type of coefficients
    description : one phrase that says what was made
    map_kind : the `Map.kind` of their UVs
    invariants() : the conformal invariants as plain data, for reports
    """

    residuals_kind = Residuals
    _unpickled = ("_triangulation", "_part", "_core")

    surface: Surface
    solver: SolverReport
    residuals: Residuals
    timings: dict[str, float]
    _solution: Solution
    _component: Surface
    _threads: int

    def _facts(self):
        return [self.description, counted(len(self._component.triangles), "triangle"), self.solver.name]

    def __getstate__(self):
        vars(self).update({name: getattr(self, name) for name in ("description", "flip_count", "_is_exact")})
        return super().__getstate__()

    _native = property(attrgetter("_solution.native"))

    @cached_property
    def _part(self):
        return part_of(self.surface, self._component)

    @property
    def _connected(self):
        """The surface, if it has one part; else the part."""
        return self.surface if len(self.surface.components) == 1 else self._component

    @cached_property
    def _core(self):
        """The core's own value, which keeps tilings."""
        return _native.forms_structure(self.map_kind, self._part, self._native)

    def computed_by(self, compute: Callable[[], Structure]) -> Self:
        """Notes the call that computes the result, for pickles, and returns the result."""
        self._solution.compute = compute
        return self

    def of_copy(self, component: Surface) -> Self:
        """The structure of a copy, with the same triangles and the same lengths up to one factor."""
        return replace(self, surface=component, _component=component)

    @cached_property
    def edges(self) -> Integers:
        """(#E, 2) vertices of the triangulation, lower first; forms are values on these. Its diagonals are flipped away
        from poles."""
        return self._of_surface(self._triangulation.edges)

    @cached_property
    def _triangulation(self):
        return self._component._native

    @cached_property
    def flip_count(self) -> int:
        """Edges flipped to make the intrinsic triangulation Delaunay."""
        return self._native.flip_count()

    @cached_property
    def _is_exact(self):
        """Whether the metric that invariants come from is that of the surface, without mollification."""
        return self._native.mollification() == 0

    def quality(self, uv: ArrayLike) -> Quality:
        """`Quality` of a (#C, 2) UV map on the triangles of `edges`."""
        return Quality.of(self._triangulation, checked_uv(uv, self._component), self._threads)

    def tile(
        self,
        tiles: float | None = None,
        *,
        evenness: float = 0.0,
        density: float | None = None,
        poles: Poles = "auto",
        lattice: str | ArrayLike = "square",
        direction: ArrayLike | str | None = "upright",
        turn: float | None = None,
        max_turn: float = 0.2,
        boundary: str = "automatic",
        max_added: float | None = None,
        allowed: ArrayLike | None = None,
        moves: Mapping[int, int] | None = None,
        turns: int | str = 1,
        texture: ArrayLike | None = None,
        lines: str = "none",
        marked: ArrayLike | None = None,
        cones: Mapping[int, float] | None = None,
        progress: Progress | None = None,
    ) -> Tiling:
        """A `Tiling`: a map of even density without visible seams, for textures that tile.

        All jumps of the UVs are translations that leave the texture as it is. Poles, around which the texture closes up
        by whole tiles, make the density even, and on surfaces with handles they move until the rounded form is
        holomorphic (Jacobi inversion), so that the map is conformal and its periods are integers at once.

        Parameters
        ----------
        evenness : from 0 for a conformal map, the default here alone, to 1 for squares of nearly one size, which are
            sheared instead. Textures look best at 0.5, the default of `automatic_map`, of the commands and in Blender.
            Fewer poles are placed for any evenness above 0
        tiles : tiles of the texture over the surface, at its median density; default: a number that suits the genus
        density : tiles per unit of area, instead
        poles : "auto" for none where the density is even without, else as many as it asks for, up to 16; a number; or a
            list of vertices, which stay where they are. Two at least on a closed surface of genus 0
        lattice : "square", "brick" (rows shifted by half), "hex", or a 2 x 2 matrix whose columns are the translations
        direction : "upright" for rows that run level: v runs along +Z, as far as it can; ignored on intrinsic surfaces.
            A (3,) vector in space along which u runs, as far as it can; any where that is normal to a plane. None for
            the most even direction. turn : radians, rotates the texture beside it; max_turn : radians by which the
            rounding may turn it away
        boundary : "automatic", "straight" or "free", see `Tiler`
        max_added : the largest `added_distortion` that is wanted; default any
        allowed : as in `tiler`
        moves : {index of a pole in the tiling: vertex} that it is moved to after the rounding, see `Tiler.move_poles`

        turns : 2, 4 or 6 where the texture looks the same after a half, a quarter or a sixth turn: then the two sides
            of a cut may turn, too. There are no poles; cones, where three or five squares meet, make the density more
            even. The choices of poles, lattice, turn and boundary do not go with it. "auto" for what
            `image_turns` finds in the texture, 1 without one
        texture : pixels, as in `image_turns`, for "auto". Its centre of turns belongs at the corners of tiles
        lines : "free" for rows that run along long hard edges and smooth boundaries, "whole" for rows that end there as
            well, where turns is 4, or 2 and the edges suit it; "mirror" for two halves that are alike; "none"
        marked : (n, 2) vertices of edges that are such lines, too; others than edges are ignored
        cones : {vertex: angle in full turns, 3/4 where three squares meet} where these are chosen, on a tiling that
            turns and has no lines. On a closed surface what is missing of full turns is the Euler characteristic

        Raises TopologyError for poles that do not fit, for fewer tiles than the surface needs (names how many are
        enough), and for more added distortion than `max_added` (names what can be had). Poles are kept.
        """
        asked = {"lattice": lattice, "direction": direction, "turn": turn, "max_turn": max_turn, "boundary": boundary}
        asked |= {"max_added": max_added, "allowed": allowed, "moves": () if moves is None else moves}
        asked |= {"turns": asked_turns(turns, texture), "lines": lines, "marked": marked, "cones": cones}
        request = Request(tiles=tiles, density=density, poles=poles, evenness=evenness, **asked)
        options = request.alone(self._component.area).tiling(self._connected)
        return Tiling.of_core(self._core.tile(options, threads=self._threads, progress=progress), self._connected)

    def tiler(
        self,
        poles: Poles = "auto",
        *,
        boundary: str = "automatic",
        allowed: ArrayLike | None = None,
        evened: bool = False,
        progress: Progress | None = None,
    ) -> Tiler:
        """The `Tiler` of the surface; the last ones are kept, with the poles that they placed, until others are asked
        for."""
        asked = Request(poles=poles, boundary=boundary, allowed=allowed).tiling(self._connected)
        core = self._core.tiler(asked, evened=bool(evened), threads=self._threads, progress=progress)
        return Tiler.of_core(self._connected, core, self._threads)

    def averaged_star(self, form: ArrayLike) -> Reals:
        """(#E,) the paper's averaged star (§ 7) of one form: the face-wise star, averaged over the two faces of an
        edge. It is not closed, so it has no well-defined integral; for comparison with `holomorphic_forms`."""
        return _native.averaged_star(self._triangulation, self._checked_form(form))

    def _checked_form(self, form):
        form = arrays.numbers(form, "form")
        if form.shape != (len(self.edges),):
            raise ValueError(f"form has the shape {form.shape}; ({len(self.edges)},) is needed")
        return form

    def _at_vertices(self, values, missing=np.nan):
        """Values at the component's vertices as values at the surface's, `missing` at isolated ones."""
        if self._component is self.surface:
            return values
        result = np.full((self.surface.given_vertex_count, *values.shape[1:]), missing, dtype=values.dtype)
        result[self._component.vertex_index] = values
        return arrays.frozen(result)

    def _of_surface(self, vertices):
        """Vertices of the component as vertices of the surface, which may have isolated ones besides."""
        return vertices if self._component is self.surface else arrays.frozen(self._component.vertex_index[vertices])


def result(kind, surface, component, native, threads, **more):
    """A `kind` of `Structure` made of what the native core computed, and `more` fields of that kind."""
    seconds = dict(native.timings())
    seconds["total"] = sum(seconds.values())
    found = native.residuals()
    residuals = kind.residuals_kind(**{entry.name: getattr(found, entry.name) for entry in fields(kind.residuals_kind)})
    report, solution = SolverReport.of(native.solver()), Solution(native)
    return kind(surface, report, residuals, seconds, solution, component, threads, **more)
