"""Maps cut along chosen edges, such as marked seams."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .._native import TopologyError
from ..core.value import Solution
from ..forms.log_map import TruncatedStructure
from ..forms.results import Structure
from ..mesh.checks import check_type, own_vertices
from ..mesh.edges import edge_keys, edges_of_keys, polygon_sides
from .disk import PlaneMap

AStructure = TypeVar("AStructure", bound=Structure)


def cut_along(structure: AStructure, edges: ArrayLike) -> AStructure:
    """The same structure, its maps cut along these edges instead of its seams. If the cut leaves several pieces, the
    UVs of each have a constant of their own. Maps of disks are continuous and need no cut.

    edges : (#S, 2) vertices of edges of faces, such as marked seams; those on the boundary do not matter. The maps must
        be single-valued on the rest, as they are on disks. None, (0, 2), leave the structure as it is

    Raises TopologyError where two vertices are joined by no edge, or a map would still jump elsewhere.
    Cost: O(#C log #C), no solve.
    Source: Gu, Wang, Yau (2003), § 4: integrals on a fundamental domain, here of a cut that is given.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> seams = structure.edges[structure.seams]
    >>> print(len(holomorph.cut_along(structure, seams).seams) <= len(seams))
    True
    """
    check_type(structure, Structure, "structure")
    given, component = np.asarray(edges), structure._component
    if not len(given):
        return structure
    if given.ndim != 2 or given.shape[1] != 2:
        raise TopologyError(f"edges has the shape {given.shape}; (rows, 2) is needed, the vertices of each edge")
    vertices, labels = own_vertices(structure.surface, component, given.ravel(), "cut vertex")
    cut = interior_edges(component, np.asarray(vertices, np.int64).reshape(-1, 2), given)
    if isinstance(structure, PlaneMap):
        return structure
    if isinstance(structure, TruncatedStructure):
        raise TopologyError(
            "the mesh is too coarse for a cut of your own: the faces around its poles meet; subdivide it"
        )
    made = replace(structure, _solution=Solution(structure._native.cut_along(cut.tolist(), labels)))
    return made.computed_by(partial(_computed_cut, structure._solution.compute, given.copy()))


def _computed_cut(compute, edges):
    return cut_along(compute(), edges)


def interior_edges(component, pairs, given):
    """Indices of the polygon edges between these (#S, 2) vertices, without those on the boundary; ascending."""
    count = len(component.vertex_index)
    sides, uses = np.unique(edge_keys(polygon_sides(component), count), return_counts=True)
    wanted = edge_keys(pairs, count)
    place = np.minimum(np.searchsorted(sides, wanted), len(sides) - 1)
    for a, b in given[sides[place] != wanted]:
        raise TopologyError(f"the cut runs between the vertices {a} and {b}, which no edge of a face joins")
    wanted = np.unique(wanted[uses[place] == 2])
    edges = component._native.edges
    # A polygon of n corners has n - 2 triangles.
    diagonals = len(component.triangles) - (len(component.face_offsets) - 1)
    return np.sort(edges_of_keys(edges[: len(edges) - diagonals], wanted, count))
