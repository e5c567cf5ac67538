"""The conformal structure of a closed surface, and everything that is read off it."""

import os
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from . import _native, arrays
from ._native import TopologyError
from .surface import Surface

SOLVERS = ("auto", "direct", "multigrid")


@dataclass(frozen=True)
class SolverReport:
    """Which solver was used and why; iterations (of multigrid, or steps of iterative refinement of the direct solver);
    the largest relative residual of the linear systems."""

    name: str
    reason: str
    iterations: int
    residual: float


@dataclass(frozen=True)
class Residuals:
    """Relative maxima over all harmonic forms, on the intrinsic triangulation that was solved on.

    closedness: sum around a face over the largest value of the form; harmonicity: sum of k h at a vertex over the
    largest sum of |k h|; periods: difference of the integral of h_j over zeta_i from delta_ij.
    """

    closedness: float
    harmonicity: float
    periods: float


@dataclass(frozen=True, eq=False)
class Quality:
    """Distortion of a UV map per triangle, s1 >= s2 its singular values.

    angle: (#T,) s1 / s2 (1 where a triangle has no area); area: (#T,) s1 s2, UV area per surface area; flipped: (#T,)
    bool; mean_angle: mean of s1 / s2 over the surface's area; density_ratio: 95 % over 5 % quantile of s1 s2 by area.
    """

    angle: np.ndarray
    area: np.ndarray
    flipped: np.ndarray
    mean_angle: float
    density_ratio: float


@dataclass(frozen=True, eq=False)
class ConformalStructure:
    """Result of `conformal_structure` for a closed surface of genus g. All arrays are read-only; the large ones are
    computed when first asked for."""

    surface: Surface
    solver: SolverReport
    residuals: Residuals
    timings: dict
    _native: object = field(repr=False)
    _component: Surface = field(repr=False)

    @cached_property
    def edges(self):
        """(#E, 2) vertices of the artist's triangulation, lower first; forms are values on these."""
        edges = self._component._native.edges
        if self._component is self.surface:
            return edges
        return arrays.frozen(self._component.vertex_index[edges])

    @cached_property
    def homology_basis(self):
        """Tuple of 2g integer arrays: closed loops zeta_i of vertices, the first not repeated (paper § 4)."""
        loops = self._native.homology_basis()
        if self._component is self.surface:
            return tuple(loops)
        return tuple(arrays.frozen(self._component.vertex_index[loop]) for loop in loops)

    @cached_property
    def intersection_matrix(self):
        """(2g, 2g) integers zeta_i . zeta_j."""
        return self._native.intersection_matrix()

    @cached_property
    def canonical_basis(self):
        """(2g, 2g) integers, |det| 1: rows a_1..a_g, b_1..b_g written in the zeta."""
        return self._native.canonical_basis()

    @cached_property
    def harmonic_forms(self):
        """(2g, #E), dual to zeta: the integral of form i over zeta_j is delta_ij (paper § 6); see `prepare_uv`."""
        return self._native.harmonic_forms()

    @cached_property
    def holomorphic_forms(self):
        """(g, #E) complex: theta_j has the period 1 over a_j and 0 over the other a (paper § 7)."""
        return arrays.frozen(self._periods.T @ self.harmonic_forms)

    @cached_property
    def gram_matrix(self):
        """(2g, 2g) L2 products of `harmonic_forms`, on the intrinsic triangulation."""
        return self._native.gram_matrix()

    @cached_property
    def period_matrix(self):
        """(g, g) complex Omega_ij, the integral of theta_j over b_i: symmetric, Im Omega > 0 (paper Eq. 13)."""
        return self._native.period_matrix()

    @cached_property
    def period_bounds(self):
        """(lower, upper), (g, g) each: guaranteed bounds of Im Omega of the polyhedral surface as quadratic forms."""
        return self._native.period_bounds()

    @cached_property
    def seams(self):
        """(#S,) indices into `edges` of the cut graph, on the artist's edges only: cut open there, a disk is left."""
        return self._native.seams()

    @cached_property
    def flip_count(self):
        """Edges turned to make the intrinsic triangulation Delaunay."""
        return self._native.intrinsic()[0]

    @cached_property
    def _periods(self):
        # (2g, g) complex: integral of theta_j over zeta_k
        return self._native.periods()

    def prepare_uv(self, progress=None):
        """Solves for the forms on the artist's own triangles, of which `harmonic_forms`, `holomorphic_forms` and UVs
        are made; done by itself when first needed, and without work where no edge had to be turned.

        Invariants come from the intrinsic Delaunay triangulation, but UVs with the least distortion on the artist's
        triangles come from those triangles. `progress` as in `conformal_structure`."""
        self._native.prepare_uv(progress)

    @cached_property
    def uv_solver(self):
        """`SolverReport` of the forms that UVs are made of: that of `prepare_uv`, else the same as `solver`."""
        return SolverReport(*self._native.uv_solver())

    def uv(self, coefficients):
        """(#C, 2) UVs of the form sum_j c_j theta_j, from g complex coefficients c. No solve: one small product.

        Across every seam the UVs jump by a constant translation, without rotation or change of scale."""
        c = np.asarray(coefficients, dtype=np.complex128)
        if c.shape != (self._periods.shape[1],) or not np.isfinite(c).all():
            wanted = f"({self._periods.shape[1]},) finite numbers are needed"
            raise ValueError(f"coefficients has the shape {c.shape}; {wanted}")
        return self._native.uv(self._periods @ c)

    def uv_of(self, n, m):
        """(#C, 2) with u = sum_j n_j h_j and v = sum_j m_j h_j, n and m of length 2g: seams jump by integers
        where n and m are integers."""
        n, m = np.asarray(n, dtype=np.float64), np.asarray(m, dtype=np.float64)
        if n.shape != (self._periods.shape[0],) or m.shape != n.shape or not np.isfinite([n, m]).all():
            count = self._periods.shape[0]
            raise ValueError(f"n and m have the shapes {n.shape} and {m.shape}; ({count},) finite numbers are needed")
        return self._native.uv(n + 1j * m)

    def balanced_coefficients(self):
        """(g,) complex coefficients of the combination whose texture density is most even (least variance of its
        logarithm over the surface's area), scaled so that the UV area of the surface is 1."""
        return self._balanced

    @cached_property
    def _balanced(self):
        return self._native.balanced_coefficients()

    def quality(self, uv):
        """`Quality` of a (#C, 2) UV map on the surface's triangles."""
        uv = np.ascontiguousarray(uv, dtype=np.float64)
        if uv.shape != (len(self._component.corner_vertices), 2):
            raise ValueError(f"uv has the shape {uv.shape}; ({len(self._component.corner_vertices)}, 2) is needed")
        return Quality(*_native.quality(self._component._native, uv))

    def averaged_star(self, form):
        """(#E,) the paper's averaged star (§ 7) of one form: the face-wise star, averaged over the two faces of an
        edge. It is not closed, so it has no well-defined integral; for comparison with `holomorphic_forms`."""
        form = np.ascontiguousarray(form, dtype=np.float64)
        if form.shape != (len(self.edges),):
            raise ValueError(f"form has the shape {form.shape}; ({len(self.edges)},) is needed")
        return self._native.averaged_star(form)


def conformal_structure(surface, *, solver="auto", threads=None, progress=None):
    """Harmonic and holomorphic one-forms and the period matrix of one connected closed surface of genus >= 1.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    solver : "direct" is a sparse Cholesky factorisation, "multigrid" iterates in linear time and memory, "auto" chooses
        by size and number of right-hand sides; the result's `solver` says what was taken and why
    threads : number of threads, None for one per core; the result has the same bits for any number
    progress : progress(fraction, stage), called at most every 20 ms; returning False cancels

    Returns
    -------
    ConformalStructure

    Raises
    ------
    TopologyError
        several components, genus 0, or a boundary (names genus and boundary count)
    SolverError
        if neither a residual of 1e-10 nor, among slivers, the level of rounding is reached, or memory runs out
    Cancelled
        if `progress` returned False

    Cost: 2g solves of the Laplacian, after one factorisation or the set-up of multigrid; 2 g #V numbers of memory.
    Source: Gu, Wang, Yau (2003), § 4 to § 7 and Eq. 13; the star by Gu & Yau (2003), projected.
    """
    if solver not in SOLVERS:
        raise ValueError(f"solver is {solver!r}; one of {', '.join(SOLVERS)} is needed")
    if threads is not None and (threads != int(threads) or threads < 1):
        raise ValueError(f"threads is {threads!r}; a positive integer or None is needed")
    count = len(surface.components)
    if count != 1:
        raise TopologyError(f"the surface has {count} connected components; take one of surface.components")
    component = surface.components[0]
    native = _native.conformal_structure(component._native, solver, int(threads or os.cpu_count() or 1), progress)
    seconds = dict(native.timings())
    seconds["total"] = sum(seconds.values())
    return ConformalStructure(
        surface, SolverReport(*native.solver()), Residuals(*native.residuals()), seconds, native, component
    )
