"""Evening: UV maps with squares of nearly one size, whose jumps stay."""

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Progress, Reals
from ..mesh.checks import check_options, checked_evenness


def evened(
    surface: _native.Surface,
    uv: ArrayLike,
    evenness: float,
    *,
    poles: ArrayLike = (),
    u: ArrayLike = (),
    v: ArrayLike = (),
    solver: str = "auto",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Reals:
    """(#C, 2) UVs: a function on the vertices is added for the least energy of strain, which weighs the sizes of
    squares against their shear. So the jumps across seams stay.

    Parameters
    ----------
    surface : the native triangulation of a connected `Surface` without isolated vertices
    uv : (#C, 2) finite UVs
    evenness : from 0, for the same UVs, to 1, for nearly one size
    poles : vertices at which the map is infinite: triangles there are to keep their shape in the plane
    u, v : vertices at which u, or v, stays as it is, bit for bit: as where the boundary is a line
    solver, threads, progress : as in `conformal_structure`

    Raises ValueError for what does not fit, TopologyError for a surface that is not connected; SolverError; Cancelled.

    Source: Neff, Eidel and Martin 2016, doi:10.1007/s00205-016-1007-x, has the energy (uv/strain_energy.h).
    """
    count = check_options(solver, threads)
    evenness, uv = checked_evenness(evenness), _checked(surface, uv)
    if surface.component_count != 1 or len(surface.isolated_vertices):
        raise TopologyError("a connected surface without isolated vertices is needed")
    names = {"poles": poles, "u": u, "v": v}
    vertices = {name: _vertices(given, name, surface.vertex_count) for name, given in names.items()}
    if evenness == 0:
        return arrays.frozen(uv.copy())
    options = {"evenness": evenness, "solver": solver, "threads": count, "progress": progress}
    added = _native.evened(surface, uv, **vertices, **options)
    return arrays.frozen(uv + added[surface.corner_vertices])


def _checked(surface, uv):
    uv = arrays.numbers(uv, "uv")
    if uv.shape != (len(surface.corner_vertices), 2):
        raise ValueError(f"uv has the shape {uv.shape}; ({len(surface.corner_vertices)}, 2) is needed")
    if not np.isfinite(uv).all():
        raise ValueError(f"uv of corner {int(np.argmin(np.isfinite(uv).all(axis=1)))} is not finite")
    return uv


def _vertices(given, name, count):
    """The vertices as a list, ascending, each once."""
    found = np.asarray(given)
    if found.ndim != 1 or not (np.issubdtype(found.dtype, np.integer) or found.size == 0):
        raise ValueError(f"{name} must be a list of vertices, not an array of {found.dtype} of {found.shape}")
    for vertex in found[(found < 0) | (found >= count)]:
        raise ValueError(f"{name} names vertex {vertex}: there are {count}")
    return np.unique(found).astype(int).tolist()
