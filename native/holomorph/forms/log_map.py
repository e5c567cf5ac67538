"""Differentials of the third kind: log maps, and on surfaces with handles the forms beside them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core.array_types import Complexes, Integers, Progress
from ..core.value import quoted
from ..mesh.checks import check_memory_limit, check_options, only_component, own_vertices
from ..mesh.surface import Surface
from .pole_structure import PoleStructure
from .results import result
from .truncated import sphere_structure


def log_map(
    surface: Surface,
    poles: Sequence[int] | Integers | None = None,
    residues: Sequence[complex] | Complexes | None = None,
    *,
    solver: str = "auto",
    threads: int | None = None,
    memory_limit: float | None = None,
    progress: Progress | None = None,
) -> PoleStructure:
    """The `PoleStructure` of one connected surface: the differential with these residues at these poles, and the
    holomorphic forms beside it. On a sphere with two poles its integral is the logarithm of the map to the plane.

    Parameters
    ----------
    surface : Surface, connected; isolated vertices are ignored
    poles : list of vertices whose stars are apart from each other and from the boundary. Default: two far apart on a
        closed surface, the vertex farthest from the boundary on others
    residues : list of complex numbers other than 0, one for each pole: the UVs change by it around the pole. On a
        closed surface they sum to 0. Default: 1 and -1 for two poles; for more, 1 but at the one that is farthest from
        the others; with a boundary 1 everywhere
    solver, threads, memory_limit, progress : as in `conformal_structure`

    Raises TopologyError for several components, and for poles or residues that do not fit; SolverError; Cancelled.

    Cost: two solves for each pole and each holomorphic form.
    Source: Gu, Wang, Yau (2003), § 11.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> print(holomorph.log_map(surface, [0, 500]).residues)
    [ 1.+0.j -1.+0.j]
    """
    count, limit = check_options(solver, threads), check_memory_limit(memory_limit)
    component, given = only_component(surface), _residues(residues)
    vertices, labels = own_vertices(surface, component, [] if poles is None else poles, "pole")
    if vertices or given or (component.genus, component.boundary_count) != (0, 0):
        native = _native.pole_structure(component._native, vertices, given, labels, solver, count, limit, progress)
        made = result(PoleStructure, surface, component, native, count)
    else:
        made = sphere_structure(surface, component, solver, count, limit, progress)
    own = np.array(poles).tolist() if vertices else None  # the caller's list may change
    options = {"solver": solver, "threads": threads, "memory_limit": memory_limit}
    return made.computed_by(partial(log_map, surface, own, given or None, **options))


def _residues(residues):
    try:
        return [] if residues is None else [complex(r) for r in residues]
    except (TypeError, ValueError, OverflowError) as error:
        raise TopologyError(f"residues must be a list of numbers, not {quoted(residues)}") from error
