"""What the results have in common that have forms to combine; the fundamental domain of their surfaces (paper § 4)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import InvalidMesh
from ..core import arrays
from ..core.array_types import Bounds, Complexes, Integers, Progress, Reals
from ..core.value import Value, counted
from ..mesh.checks import checked_coefficients
from .certificate import Certificate, certificate
from .narrow_bounds import Refinement
from .results import MemoryPlan, SolverReport, Structure


@dataclass(frozen=True, eq=False, repr=False)
class FundamentalDomain(Value):
    """The paper's disk D of all triangles, each joined to those before it across one edge (§ 4.1). The edges that were
    not crossed, diagonals of polygons never among them, are the graph G with its dangling branches; `spanning_tree` and
    `generator_edges` are part of it. Edges are indices into `edges` of the structure.

    The paper takes triangles from a plain queue; here the order is such that loops are short (docs/method.md).

    faces : (#T,) triangles in the order of D
    joined : (#T,) edge across which each was joined to a triangle before it; -1 for the first
    boundary : (#B, 2) vertices, from and to, of the oriented edges around D after the paper's step 3, in order, D on
        their left: each edge of the cut graph in both directions (`seams`, unless those were chosen), each edge of the
        surface's boundary in one
    boundary_edges : (#B,) the same edges
    generator_edges : (2g,) the edges e_i of G outside its spanning tree T. Closed in T each is the loop zeta_i of
        `homology_basis`, which begins with it; of levels, and of the paper's solver, those loops come from the base
        mesh instead
    """

    faces: Integers
    joined: Integers
    boundary: Integers
    boundary_edges: Integers
    generator_edges: Integers

    def _facts(self):
        return [counted(len(self.faces), "triangle"), counted(len(self.boundary), "boundary edge")]


@dataclass(frozen=True, eq=False, repr=False)
class Zeros(Value):
    """The zeros of a differential, where its UV map branches.

    vertices : (k,) vertices of the surface. A zero that the mesh spreads over vertices and flipped triangles that touch
        is one, named by the vertex with the largest part; those in the star of a pole are named by a vertex around
        it
    orders : (k,) integers: around the vertex the map turns 2 pi (order + 1); on a boundary pi (order + 1). On a closed
        surface their sum is 2g - 2, with p poles 2g - 2 + p, exactly; with b boundary loops the orders on them and
        twice the others are 4g - 4 + 2b + 2p together. A negative order is a defect of a coarse
        map: beside it, zeros are too many
    positions : (k, 3) of the vertices; None on an intrinsic surface
    """

    vertices: Integers
    orders: Integers
    positions: Reals | None

    def _facts(self):
        return [counted(len(self.vertices), "zero"), f"the sum of their orders {int(self.orders.sum())}"]


@dataclass(frozen=True, eq=False, repr=False)
class FormStructure(Structure):
    """Base of the results with forms to combine: differentials made of real harmonic forms h_1 .. h_m, whose integrals'
    real and imaginary parts are UV maps."""

    coefficient_type = np.complex128

    @cached_property
    def _triangulation(self):
        return self._native.surface()

    @cached_property
    def homology_basis(self) -> tuple[Integers, ...]:
        """Tuple of integer arrays: 2g closed loops zeta_i of vertices, the first not repeated (paper § 4), then, with
        b boundary loops, the loops 1 .. b-1."""
        return tuple(self._of_surface(loop) for loop in self._native.homology_basis())

    @cached_property
    def seams(self) -> Integers:
        """(#S,) indices into `edges` of the cut graph, on edges of polygons only: cut open there, a disk is left. The
        cut graph ends at poles, and the edges there are seams, too."""
        return self._native.seams()

    @cached_property
    def period_matrix(self) -> Complexes:
        """(n, n) complex Omega: symmetric, Im Omega > 0 (paper Eq. 13). Closed: the integral of theta_j over b_i. With
        boundary that of the double: (i/2) `capacity_matrix` on planar surfaces."""
        return self._native.period_matrix()

    @cached_property
    def period_bounds(self) -> Bounds | None:
        """(lower, upper), (n, n) each: guaranteed bounds of Im Omega of the polyhedral surface, with boundary of its
        double, as quadratic forms. None where degenerate triangles had to be mollified: another surface was solved
        on."""
        return self._native.period_bounds() if self._is_exact else None

    @cached_property
    def memory(self) -> MemoryPlan:
        """`MemoryPlan`: whether all forms are kept, and the memory that was reckoned with."""
        plan = self._native.memory()
        return MemoryPlan(plan.keeps_forms, plan.block, plan.bytes)

    def prepare_uv(self, progress: Progress | None = None) -> None:
        """Solves for the forms on the surface's own triangles, of which forms and UVs are made; done by itself when
        first needed, and without work where no edge had to be flipped.

        Invariants come from the intrinsic Delaunay triangulation, but UVs with the least distortion on the surface's
        triangles come from those triangles. `progress` as in `conformal_structure`."""
        self._native.prepare_uv(progress)

    @cached_property
    def uv_solver(self) -> SolverReport:
        """`SolverReport` of the forms that UVs are made of: that of `prepare_uv`, else the same as `solver`."""
        return SolverReport.of(self._native.uv_solver())

    @cached_property
    def _differentials(self):
        """(m, n) complex: column j is theta_j in the basis of the harmonic forms."""
        return self._native.differentials()

    @cached_property
    def _harmonic_forms(self):
        """(m, #E): all of them."""
        count, edges = self._native.families().count, len(self.edges)
        self._native.require_memory(f"the {count} harmonic forms on {edges} edges", 8 * count * edges)
        return self._native.basis_forms()

    @cached_property
    def holomorphic_forms(self) -> Complexes:
        """(n, #E) complex, paper § 7. Closed: theta_j has the period 1 over a_j and 0 over the other a. With boundary:
        theta_i = h^N_i + i sum_j C#_ij h^D_j. With poles theta_0 comes first, NaN on the edges that end at one."""
        n, edges = self._differentials.shape[1], len(self.edges)
        # The harmonic forms, and two matrices of the size of the result.
        self._native.require_memory(f"the {n} holomorphic forms on {edges} edges", 3 * 16 * n * edges)
        values = self._differentials.T @ self._harmonic_forms
        values[:1, self._native.spokes()] = np.nan
        return arrays.frozen(values)

    @cached_property
    def edge_weights(self) -> Reals:
        """(#E,) the weights k = (cot a + cot b) / 2 (paper Eq. 3) on the triangles of `edges`, on which forms and UVs
        are harmonic. Negative where the edge is not Delaunay; invariants come from the intrinsic triangulation, where
        inner edges are."""
        return _native.edge_weights(self._triangulation)

    def vectors(self, form: ArrayLike) -> Reals | Complexes:
        """(#T, 3) one closed form, (#E,) real or complex, as a vector of each triangle of the triangulation: in its
        plane, with the form's values as products with its sides (paper Eq. 9): of sides 0 and 2, which start and end at
        the first corner. NaN in triangles without area.

        The star turns the vectors by a right angle. Raises InvalidMesh for an intrinsic surface."""
        form = np.asarray(form)
        if np.iscomplexobj(form):
            form = self._checked_form(form.real) + 1j * self._checked_form(form.imag)
        else:
            form = self._checked_form(form)
        surface = self._triangulation
        if surface.intrinsic:
            raise InvalidMesh("vectors need positions, and this surface has edge lengths only")
        first, second, third = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
        ahead, back = second - first, third - first
        normal = np.cross(ahead, back)
        sides = surface.triangle_edges[:, [0, 2]]
        start, end = surface.triangles[:, [0, 0]], surface.triangles[:, [1, 2]]
        along = np.where(start < end, form[sides], -form[sides])
        with np.errstate(divide="ignore", invalid="ignore"):
            field = along[:, :1] * np.cross(back, normal) + along[:, 1:] * np.cross(normal, ahead)
            field /= (normal**2).sum(axis=1)[:, None]
        field[~np.isfinite(field)] = np.nan
        return arrays.frozen(field)

    def uv(self, coefficients: ArrayLike) -> Reals:
        """(#C, 2) UVs of the differential sum_j c_j theta_j, one coefficient c_j for each: complex, real on surfaces
        with boundary and without poles. No solve: one small product; where the forms were not kept (`memory`), a
        solve for this map alone.

        Across every seam the UVs jump by a constant translation, without rotation or change of scale; only the edges at
        a pole, where each triangle has an apex of its own, are cut. On a boundary loop v is the same number at all
        corners, up to a period where a seam meets it; with poles for real coefficients and residues."""
        c = checked_coefficients(coefficients, self._differentials.shape[1], self.coefficient_type)
        return self._native.uv(self._differentials @ c)

    def zeros(self, coefficients: ArrayLike) -> Zeros:
        """`Zeros` of the differential sum_j c_j theta_j, the coefficients as in `uv`. Its index at a vertex is the sum
        of the signed angles of the image over 2 pi, minus 1; a flipped triangle counts 1."""
        poles = self._native.poles()
        vertices, orders = _native.zeros(self._triangulation, self.uv(coefficients), poles)
        positions = self._component.vertices
        at = None if positions is None else positions[vertices]
        return Zeros(self._of_surface(vertices), orders, at)

    @property
    def form_count(self) -> int:
        """How many `holomorphic_forms` there are."""
        return self._differentials.shape[1]

    def balanced_coefficients(self, progress: Progress | None = None) -> Complexes:
        """(n,) coefficients of the combination whose texture density is most even (least variance of its logarithm over
        the surface's area), scaled so that the UV area of the surface is 1; `progress` as in `conformal_structure`."""
        if "_balanced" not in vars(self):
            c = self._native.balanced_coefficients(progress)
            vars(self)["_balanced"] = arrays.frozen(c.real.copy() if self.coefficient_type is np.float64 else c)
        return vars(self)["_balanced"]


@dataclass(frozen=True, eq=False, repr=False)
class CertifiedStructure(FormStructure):
    """Base of the results whose conformal invariants have guaranteed bounds.

    refinement : `Refinement` where narrower bounds were asked for, else None
    """

    refinement: Refinement | None = None

    @cached_property
    def integer_classes(self) -> Integers:
        """(n, #E) int32, n = 2g, with boundary 2g + b - 1: closed forms with integer values, form i with the integral
        delta_ij over loop j of `homology_basis`, exactly (paper § 5, Eq. 1 and 2). Form i counts the crossings of a
        loop of triangles, or of a path of triangles between two boundary loops."""
        count, edges = self._native.families().natural, len(self.edges)
        self._native.require_memory(f"the {count} integer classes on {edges} edges", 4 * count * edges)
        return self._native.integer_classes()

    @property
    def fundamental_domain(self) -> FundamentalDomain:
        """`FundamentalDomain` D of the surface (paper § 4.1). Cost: near-linear."""
        return self._domain_and_tree[0]

    @property
    def spanning_tree(self) -> Integers:
        """(#V - 1,) edges of the spanning tree T of the graph G (paper § 4.2) and of G's dangling branches: all
        vertices. Each joins a vertex to the root, an end of the first edge, or to those of the edges before."""
        return self._domain_and_tree[1]

    @cached_property
    def _domain_and_tree(self):
        faces, joined, half_edges, tree, left_over = self._native.fundamental_domain()
        ends = self.edges[half_edges >> 1]
        ends = np.where((half_edges & 1).astype(bool)[:, None], ends[:, ::-1], ends)
        return FundamentalDomain(faces, joined, arrays.frozen(ends), arrays.frozen(half_edges >> 1), left_over), tree

    @cached_property
    def certificate(self) -> Certificate:
        """`Certificate`: the bounds, whether they are proven for the surface as given, and what was measured."""
        return certificate(self)
