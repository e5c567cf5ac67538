"""The islands into which seams cut a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..mesh.checks import check_type, real_number
from ..mesh.cut_open import cut_open
from ..mesh.edges import edge_keys
from ..mesh.hard_edges import is_hard
from ..mesh.surface import Surface


def islands(
    surface: Surface, seams: ArrayLike = (), strict: bool = True, *, hard_edges: float | None = None
) -> tuple[Surface, ...]:
    """The parts into which the seams cut the surface, each a connected `Surface`, ordered by their first face.

    A vertex becomes one vertex for each fan of faces that the seams leave at it; a seam that ends inside a part cuts it
    open, too. A face without area is in the part at its longest side, whatever the seams. `vertex_index`, `face_index`
    and `corner_index` of the parts are those of the mesh as given.

    Parameters
    ----------
    surface : Surface with positions
    seams : (#S, 2) vertices of edges, as the mesh was given; those on the boundary do not matter
    strict : refuse vertices that no edge of a face joins, else pass over them
    hard_edges : degrees between the normals of two faces; where they differ by more, the edge is a seam, too. A part
        that has a tip then, a vertex inside with more than 60 degrees too few or too many around it, such as that of a
        cone, is cut from there to the nearest seam. None: only the seams that are given

    Raises TopologyError for other shapes or types, and for such vertices; ValueError for an invalid angle.

    Cost: O(#C log #C).
    Source: ours, docs/choice.md.

    Examples
    --------
    >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = holomorph.Surface(corners, sides)
    >>> print(len(holomorph.islands(cube, hard_edges=60)))
    6
    """
    check_type(surface, Surface)
    if surface.vertices is None:
        raise TopologyError("islands need a surface with positions; this one has edge lengths only")
    edges = surface._native.edges
    diagonals = len(surface.triangles) - (len(surface.face_offsets) - 1)  # a polygon of n corners has n - 2 triangles
    sides = edge_keys(surface.vertex_index[edges[: len(edges) - diagonals]], surface.given_vertex_count)
    wanted = _seam_keys(surface, seams, sides, strict)
    is_seam = np.zeros(len(edges), bool)
    is_seam[: len(sides)] = np.isin(sides, wanted)
    if hard_edges is not None:
        is_seam |= is_hard(surface, real_number(hard_edges, "hard_edges", positive=True))
        is_seam |= _native.cuts_to_tips(surface._native, is_seam)
    return cut_open(surface, is_seam).components


def _seam_keys(surface, seams, sides, strict):
    seams = np.asarray(seams)
    if seams.size == 0:
        return np.empty(0, np.int64)
    if seams.ndim != 2 or seams.shape[1] != 2 or not np.issubdtype(seams.dtype, np.integer):
        raise TopologyError(
            f"seams are an array of {seams.dtype} of {seams.shape}; (rows, 2) integers are needed, vertices of edges"
        )
    is_vertex = ((seams >= 0) & (seams < surface.given_vertex_count)).all(axis=1)
    wanted = edge_keys(surface._origin.lowest(seams), surface.given_vertex_count)
    is_known = is_vertex & np.isin(wanted, sides)
    for a, b in seams[~is_known] if strict else ():
        raise TopologyError(f"a seam runs between the vertices {a} and {b}, which no edge of a face joins")
    return wanted[is_known]
