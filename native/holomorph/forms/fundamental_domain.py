"""The fundamental domain of a surface, outside of which is a graph with the same homology (paper § 4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core import arrays
from ..core.array_types import Integers
from ..core.value import Value, counted


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


def domain_and_tree(native, edges):
    """The `FundamentalDomain` of a native structure with these edges, (#E, 2) vertices, and the spanning tree."""
    faces, joined, half_edges, tree, left_over = native.fundamental_domain()
    ends = edges[half_edges >> 1]
    ends = np.where((half_edges & 1).astype(bool)[:, None], ends[:, ::-1], ends)
    return FundamentalDomain(faces, joined, arrays.frozen(ends), arrays.frozen(half_edges >> 1), left_over), tree
