"""What the results of all kinds of surfaces have in common."""

import os
from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

from . import _native, arrays
from ._native import TopologyError
from .surface import Surface

SOLVERS = ("auto", "direct", "multigrid", "paper")


@dataclass(frozen=True)
class SolverReport:
    """Which solver was used and why; iterations (of multigrid or, by the paper's solver, on the surface itself; steps
    of iterative refinement of the direct solver); the largest relative residual of the linear systems.

    levels : (faces, iterations, seconds) of the paper's solver on each level of the progressive mesh, the base mesh
        first and the surface last, where the seconds of a level include making its linear system; () for other solvers
    """

    name: str
    reason: str
    iterations: int
    residual: float
    levels: tuple = ()


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
    """What `memory_limit` led to. keeps_forms: all harmonic functions stay in memory, else each block of forms goes
    when it was measured; block: right-hand sides solved for at a time; bytes: estimate of the most memory in use at
    once, beside the surface itself."""

    keeps_forms: bool
    block: int
    bytes: int


@dataclass(frozen=True)
class BoundedResiduals(Residuals):
    """Those of both families; harmonicity at every vertex for the natural forms, at the inner ones for the Dirichlet
    forms; periods of the natural forms. pairing: largest difference of the integral of h^N_i ^ h from what the integers
    W say, for one h = sum of +-h^D_j."""

    pairing: float


@dataclass(frozen=True, eq=False)
class Quality:
    """Distortion of a UV map per triangle, s1 >= s2 its singular values.

    angle: (#T,) s1 / s2 (1 where a triangle has no area, infinite where it has collapsed); area: (#T,) s1 s2, UV area
    per surface area; flipped: (#T,) bool; mean_angle: mean of s1 / s2 over the area of the triangles that have not
    collapsed; density_ratio: 95 % over 5 % quantile of s1 s2 by area; median_density: its 50 % quantile.
    """

    angle: np.ndarray
    area: np.ndarray
    flipped: np.ndarray
    mean_angle: float
    density_ratio: float
    median_density: float

    @property
    def collapsed(self):
        """(#T,) bool: the map leaves a triangle with area next to none."""
        return np.isinf(self.angle)


@dataclass(frozen=True, eq=False)
class Structure:
    """Base of the results of `conformal_structure`. All arrays are read-only; the large ones are computed when first
    asked for. Each kind of result adds its forms, its invariants and

    uv(coefficients) : (#C, 2) UVs of a combination of `holomorphic_forms`, without a solve
    balanced_coefficients() : those of the map that is shown first
    description : one phrase that says what was made
    invariants() : the conformal invariants as plain data, for reports
    """

    residuals_kind = Residuals

    surface: Surface
    solver: SolverReport
    residuals: Residuals
    timings: dict
    _native: object = field(repr=False)
    _component: Surface = field(repr=False)
    _threads: int = field(repr=False)

    @cached_property
    def edges(self):
        """(#E, 2) vertices of the triangulation, lower first; forms are values on these. Its diagonals are flipped away
        from punctures."""
        return self._of_surface(self._triangulation.edges)

    @cached_property
    def _triangulation(self):
        return self._component._native

    @cached_property
    def flip_count(self):
        """Edges flipped to make the intrinsic triangulation Delaunay."""
        return self._native.intrinsic()[0]

    def quality(self, uv):
        """`Quality` of a (#C, 2) UV map on the triangles of `edges`."""
        return Quality(*_native.quality(self._triangulation, self._checked_uv(uv), self._threads))

    def averaged_star(self, form):
        """(#E,) the paper's averaged star (§ 7) of one form: the face-wise star, averaged over the two faces of an
        edge. It is not closed, so it has no well-defined integral; for comparison with `holomorphic_forms`."""
        return _native.averaged_star(self._triangulation, self._checked_form(form))

    def _checked_form(self, form):
        form = np.ascontiguousarray(form, dtype=np.float64)
        if form.shape != (len(self.edges),):
            raise ValueError(f"form has the shape {form.shape}; ({len(self.edges)},) is needed")
        return form

    def _checked_uv(self, uv):
        uv = np.ascontiguousarray(uv, dtype=np.float64)
        if uv.shape != (len(self._component.corner_vertices), 2):
            raise ValueError(f"uv has the shape {uv.shape}; ({len(self._component.corner_vertices)}, 2) is needed")
        return uv

    def _at_vertices(self, values):
        """Values at the component's vertices as values at the surface's, NaN at isolated ones."""
        if self._component is self.surface:
            return values
        result = np.full((self.surface._native.vertex_count, *values.shape[1:]), np.nan, dtype=values.dtype)
        result[self._component.vertex_index] = values
        return arrays.frozen(result)

    def _of_surface(self, vertices):
        """Vertices of the component as vertices of the surface, which may have isolated ones besides."""
        return vertices if self._component is self.surface else arrays.frozen(self._component.vertex_index[vertices])


@dataclass(frozen=True, eq=False)
class FormStructure(Structure):
    """Base of the results that have forms to combine: differentials made of real harmonic forms h_1 .. h_m, of which the
    UV maps are real and imaginary parts of integrals."""

    coefficient_type = np.complex128

    @cached_property
    def _triangulation(self):
        return self._native.surface()

    @cached_property
    def homology_basis(self):
        """Tuple of integer arrays: 2g closed loops zeta_i of vertices, the first not repeated (paper § 4), then, with b
        boundary loops, the loops 1 .. b-1."""
        return tuple(self._of_surface(loop) for loop in self._native.homology_basis())

    @cached_property
    def seams(self):
        """(#S,) indices into `edges` of the cut graph, on the polygons' edges only: cut open there, a disk is left. With
        punctures it ends there, and the edges at the punctures are seams, too."""
        return self._native.seams()

    @cached_property
    def period_matrix(self):
        """(n, n) complex Omega: symmetric, Im Omega > 0 (paper Eq. 13). Closed: the integral of theta_j over b_i. With
        boundary that of the double: (i/2) `capacity_matrix` on planar surfaces."""
        return self._native.period_matrix()

    @cached_property
    def period_bounds(self):
        """(lower, upper), (n, n) each: guaranteed bounds of Im Omega of the polyhedral surface, with boundary of its
        double, as quadratic forms."""
        return self._native.period_bounds()

    @cached_property
    def memory(self):
        """`MemoryPlan`: whether all forms are kept, and the memory that was reckoned with."""
        return MemoryPlan(*self._native.memory())

    def prepare_uv(self, progress=None):
        """Solves for the forms on the surface's own triangles, of which forms and UVs are made; done by itself when
        first needed, and without work where no edge had to be flipped.

        Invariants come from the intrinsic Delaunay triangulation, but UVs with the least distortion on the surface's
        triangles come from those triangles. `progress` as in `conformal_structure`."""
        self._native.prepare_uv(progress)

    @cached_property
    def uv_solver(self):
        """`SolverReport` of the forms that UVs are made of: that of `prepare_uv`, else the same as `solver`."""
        return SolverReport(*self._native.uv_solver())

    @cached_property
    def _differentials(self):
        # (m, n) complex: column j is the j-th differential, written in the harmonic forms
        return self._native.differentials()

    @cached_property
    def _harmonic_forms(self):
        # (m, #E): all of them
        count, edges = sum(self._native.families()) + self._native.families()[2], len(self.edges)
        self._native.require_memory(f"the {count} harmonic forms on {edges} edges", 8 * count * edges)
        return self._native.basis_forms()

    @cached_property
    def holomorphic_forms(self):
        """(n, #E) complex, paper § 7. Closed: theta_j has the period 1 over a_j and 0 over the other a. With boundary:
        theta_i = h^N_i + i sum_j C#_ij h^D_j. With punctures theta_0 comes first, NaN on the edges that end at one."""
        n, edges = self._differentials.shape[1], len(self.edges)
        # of the harmonic forms, and of two matrices of the size of the result
        self._native.require_memory(f"the {n} holomorphic forms on {edges} edges", 3 * 16 * n * edges)
        values = self._differentials.T @ self._harmonic_forms
        values[:1, self._native.spokes()] = np.nan
        return arrays.frozen(values)

    def uv(self, coefficients):
        """(#C, 2) UVs of the differential sum_j c_j theta_j, one coefficient c_j for each: complex, real on surfaces
        with boundary and without punctures. No solve: one small product; where the forms were not kept (`memory`), a
        solve for this map alone.

        Across every seam the UVs jump by a constant translation, without rotation or change of scale; only the edges at
        a puncture, where each triangle has an apex of its own, are cut. On a boundary loop v is the same number at all
        corners, up to a period where a seam meets it; with punctures for real coefficients and residues."""
        c = checked_coefficients(coefficients, self._differentials.shape[1], self.coefficient_type)
        return self._native.uv(self._differentials @ c)

    def balanced_coefficients(self):
        """(n,) coefficients of the combination whose texture density is most even (least variance of its logarithm over
        the surface's area), scaled so that the UV area of the surface is 1."""
        return self._balanced

    @cached_property
    def _balanced(self):
        c = self._native.balanced_coefficients()
        return arrays.frozen(c.real.copy() if self.coefficient_type is np.float64 else c)


def check_options(solver, threads):
    """The number of threads to use. @throws ValueError"""
    if solver not in SOLVERS:
        raise ValueError(f"solver is {solver!r}; one of {', '.join(SOLVERS)} is needed")
    if threads is not None and (threads != int(threads) or threads < 1):
        raise ValueError(f"threads is {threads!r}; a positive integer or None is needed")
    return int(threads or os.cpu_count() or 1)


def check_memory_limit(memory_limit):
    """The limit in bytes, 0 for none. @throws ValueError"""
    if memory_limit is None:
        return 0
    if isinstance(memory_limit, bool) or not 1 <= memory_limit < 2**63:
        raise ValueError(f"memory_limit is {memory_limit!r}; a positive number of bytes or None is needed")
    return int(memory_limit)


def only_component(surface):
    """The one component of a connected surface, without isolated vertices. @throws TopologyError"""
    count = len(surface.components)
    if count != 1:
        raise TopologyError(f"the surface has {count} connected components; take one of surface.components")
    return surface.components[0]


def own_vertices(surface, component, vertices, word):
    """`vertices` of the surface as a list of the component's, and the surface's index of each of the component's
    vertices; `word` is what one is called in messages.

    Raises TopologyError for anything but indices of vertices that have a face.
    """
    given = np.asarray(vertices)
    if given.ndim != 1 or not (np.issubdtype(given.dtype, np.integer) or given.size == 0):
        raise TopologyError(f"{word}s must be a list of vertex indices, not an array of {given.dtype} of {given.shape}")
    count = surface._native.vertex_count
    for vertex in given[(given < 0) | (given >= count)]:
        raise TopologyError(f"{word} {vertex} is no vertex: there are {count}")
    if component is surface:
        return given.tolist(), []
    own = np.full(count, -1)
    own[component.vertex_index] = np.arange(len(component.vertex_index))
    for vertex in given[own[given.astype(int)] < 0]:
        raise TopologyError(f"{word} {vertex} is a vertex of no face")
    return own[given.astype(int)].tolist(), component.vertex_index.tolist()


def result(kind, surface, component, native, threads):
    """A `kind` of `Structure` made of what the native core computed."""
    seconds = dict(native.timings())
    seconds["total"] = sum(seconds.values())
    certificate = dict(zip(("closedness", "harmonicity", "periods", "pairing", "asymmetry"), native.certificate()))
    residuals = kind.residuals_kind(**{entry.name: certificate[entry.name] for entry in fields(kind.residuals_kind)})
    return kind(surface, SolverReport(*native.solver()), residuals, seconds, native, component, threads)


def checked_coefficients(coefficients, count, kind):
    """`coefficients` as (count,) finite numbers of type `kind`. @throws ValueError"""
    c = np.asarray(coefficients)
    if c.shape != (count,) or not np.isfinite(c).all() or (kind is not np.complex128 and np.iscomplexobj(c)):
        wanted = f"({count},) finite {'numbers are' if kind is np.complex128 else 'real numbers are'} needed"
        raise ValueError(f"coefficients has the shape {c.shape}; {wanted}")
    return c.astype(kind)
