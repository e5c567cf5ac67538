"""The levels of a progressive mesh: UV maps that do not move from level to level, loops and closed forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._native import InvalidMesh
from ..core import arrays
from ..core.array_types import Integers, Progress, Reals
from ..core.progress import scaled
from ..core.value import Value, counted
from ..forms.results import SolverReport
from ..mesh.checks import check_list, check_options
from ..mesh.surface import Surface
from ..tiling.request import checked_turns

if TYPE_CHECKING:
    from .progressive import ProgressiveMesh


@dataclass(frozen=True, eq=False, repr=False)
class LevelOfDetail(Value):
    """One level with the UV maps of the original.

    surface : Surface, triangles; its vertices are some of the original's, by `vertex_index`, its triangles come from
        the polygons `face_index`
    uv : (#C, 2) or (#C, m, 2), as was given
    corners : (#C,) polygon corner of the original whose data each corner has: at the same vertex, and on the same side
        of the seams, as far as there is one
    drift : (#V,) or (#V, m) distance of the UVs of each vertex from those that it has in the original
    vertex_map : (#V of the original,) vertex of the level that each was collapsed into; -1 for isolated ones
    solver : SolverReport of a harmonic map, else None
    """

    surface: Surface
    uv: Reals
    corners: Integers
    drift: Reals
    vertex_map: Integers
    solver: SolverReport | None

    def _facts(self):
        return [
            counted(len(self.surface.triangles), "triangle"),
            f"largest drift {np.max(self.drift, initial=0.0):.2g}",
        ]


def levels_of_detail(
    mesh: ProgressiveMesh,
    uv: ArrayLike,
    n_faces: Sequence[int],
    *,
    harmonic: bool = False,
    turns: int | Sequence[int] = 1,
    solver: str = "auto",
    threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[LevelOfDetail, ...]:
    """Levels with UV maps of the original, whose textures do not move from level to level.

    A UV map of a holomorphic form jumps across its seams by translations. Every level gets a map with the same
    periods over the lifted loops, whose seams are the images of the seams under the collapses: each vertex
    keeps the UVs that it has in the original, exactly. With `harmonic` the map is then made the harmonic
    one of these periods on the triangles of the level, which is the form that would be computed there; its
    constant is such that it does not move on average, and `drift` tells how far each vertex moves.

    Any other UV map is collapsed likewise: within its islands every vertex keeps its UVs.

    A map that turns across its seams, too, keeps its turns and its cones: `kept` of the progressive mesh names these
    (`cones`), and no level has fewer vertices.

    Parameters
    ----------
    uv : (#C, 2) of the original's polygon corners, or (#C, m, 2) for several maps
    n_faces : numbers of triangles, as in `level`; one level each
    harmonic : whether to solve on each level; for one surface with handles or two boundary loops, and maps that are
        translated across seams and have straight boundaries: v constant along each
    turns : 2, 4 or 6 where UVs also turn by this part of a full turn, see `Tiling.turns`; of each map, or of all
    solver, threads, progress : as in `holomorph.conformal_structure`, for `harmonic`

    Returns
    -------
    tuple of LevelOfDetail

    Raises
    ------
    InvalidMesh
        if `uv` does not fit the corners or is not finite, or if `harmonic` finds a seam with a rotation or a scaling,
        or a boundary that is not straight
    TopologyError
        if `harmonic` does not apply to the topology, or a cone was not kept

    Cost: linear in the number of corners; with `harmonic` 2m solves on each level.
    """
    threads = check_options(solver, threads)
    uv, maps = _maps(uv, mesh._corner_count)
    check_list(n_faces, "n_faces")
    splits = [mesh._split_count(n) for n in n_faces]
    of_maps = np.broadcast_to(np.asarray(turns, object), maps.shape[1] // 2)
    collapsed = mesh._native.collapsed_corner_values(maps, splits, [checked_turns(each) for each in of_maps])
    levels = []
    for index, (count, (values, corners)) in enumerate(zip(splits, collapsed)):
        surface, report = mesh._level(count), None
        moves = np.zeros((len(surface.vertices), values.shape[1]))
        if harmonic:
            part = scaled(progress, index / len(splits), (index + 1) / len(splits))
            made = _native.harmonic_map(surface._native, values, solver, threads, part)
            moves, report = made.moves, SolverReport.of(made.solver)
            values = values + moves[surface.corner_vertices]
        drift = np.linalg.norm(moves.reshape(len(moves), *uv.shape[1:]), axis=-1)
        values = arrays.frozen(values.reshape(-1, *uv.shape[1:]))
        vertex_map = arrays.frozen(mesh._map_of_original(count))
        levels.append(LevelOfDetail(surface, values, corners, arrays.frozen(drift), vertex_map, report))
    return tuple(levels)


def cones(surface: Surface, uv: ArrayLike, turns: int) -> Integers:
    """(n,) vertices around which the (#C, 2) UVs of a map that turns do so by more or less than a full turn."""
    uv, _ = _maps(uv, len(surface.corner_vertices))
    return arrays.frozen(_native.cones(surface._native, uv, checked_turns(turns)))


def level_corner_data(mesh: ProgressiveMesh, n_faces: int) -> NDArray[Any] | None:
    """Rows of `corner_data` for the corners of ``level(n_faces)``, None if there are none: that of a corner of the
    original at the same vertex and on the same side of all edges across which the data jump; where the vertex has
    no corner on that side, that of the corner which the triangle had in the original."""
    data = mesh.corner_data
    if data is None:
        return None
    rows = np.ascontiguousarray(data).reshape(len(data), -1)
    kinds = np.zeros(len(rows))
    if rows.size:
        rows = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1])))[:, 0]
        kinds = np.unique(rows, return_inverse=True)[1].astype(float)
    ((_, corners),) = mesh._native.collapsed_corner_values(kinds[:, None], [mesh._split_count(n_faces)], [])
    return arrays.frozen(data[corners])


def _maps(uv, corner_count):
    """The array as given, and as one row of 2m numbers for each corner."""
    uv = arrays.numbers(uv, "uv")
    if uv.ndim not in (2, 3) or uv.shape[0] != corner_count or uv.shape[-1] != 2 or uv.size == 0:
        wanted = f"({corner_count}, 2) or ({corner_count}, maps, 2)"
        raise InvalidMesh(f"uv has the shape {uv.shape}; {wanted} is needed")
    rows = np.ascontiguousarray(uv.reshape(corner_count, -1))
    if not np.isfinite(rows).all():
        corner = int(np.argmin(np.isfinite(rows).all(axis=1)))
        raise InvalidMesh(f"uv of corner {corner} is not finite")
    return uv, rows


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
