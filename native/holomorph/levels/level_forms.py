"""Loops and closed forms of the base of a progressive mesh, carried to its levels (paper section 9)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._native import InvalidMesh
from ..core import arrays
from ..core.array_types import Integers
from ..mesh.checks import check_list

if TYPE_CHECKING:
    from .progressive import ProgressiveMesh


def lift_loops(mesh: ProgressiveMesh, loops: Sequence[Integers], n_faces: int | None = None) -> list[Integers]:
    """Lifts closed loops of vertices of the base to ``level(n_faces)``, or to the original by default: where a split
    separates the two neighbours of a vertex on a loop, the new edge is inserted (paper section 9).

    Parameters
    ----------
    loops : sequence of integer arrays, the first vertex not repeated, as in ``homology_basis``

    Returns
    -------
    list of integer arrays
    """
    count = len(mesh._native.split_slots)
    splits = count if n_faces is None else mesh._split_count(n_faces)
    check_list(loops, "loops")
    given = [arrays.integer(loop, "loop") for loop in loops]
    for loop in given:
        if len(loop) == 0 or loop.min() < 0 or loop.max() >= mesh._native.base_vertex_count:
            raise InvalidMesh("a loop is empty or names a vertex that is not in the base mesh")
    lifted = mesh._native.lift_loops(splits, [loop.tolist() for loop in given])
    if n_faces is None:
        lifted = [arrays.frozen(mesh._native.vertex_index[loop]) for loop in lifted]
    return lifted


def pull_back_forms(mesh: ProgressiveMesh, forms: ArrayLike, n_faces: int | None = None) -> NDArray[Any]:
    """Pulls closed forms on the edges of the base back to those of ``level(n_faces)``, or of the original's
    triangulation by default: a new edge v_s v_t gets 0, and an edge of v_t the value of the edge of v_s that it comes
    from (paper section 9, step 5b). The period over a lifted loop is that over the loop.

    Parameters
    ----------
    forms : (n, #E of the base) integers or reals, for the direction from lower to higher vertex

    Returns
    -------
    (n, #E) numbers of the same type: int64 or float64
    """
    forms = np.asarray(forms)
    if n_faces is None:
        surface, splits = mesh.restore(), 0
        vertex_map = mesh._map_of_original(splits)
    else:
        surface = mesh.level(n_faces)
        vertex_map = mesh._native.vertex_map(0)[: len(surface.vertices)]
    if forms.ndim != 2 or forms.shape[1] != len(mesh.base._native.edges):
        raise InvalidMesh(f"forms has the shape {forms.shape}; (rows, {len(mesh.base._native.edges)}) is needed")
    half_edge = mesh._native.base_half_edges(surface._native, vertex_map.tolist())
    kind = np.int64 if np.issubdtype(forms.dtype, np.integer) else np.float64
    sign = np.where(half_edge < 0, 0, 1 - 2 * (half_edge & 1)).astype(kind)
    return arrays.frozen(forms[:, half_edge >> 1].astype(kind) * sign)
