"""Differentials of the third kind: log maps, maps to the sphere, and on surfaces with handles the forms beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from .. import _native
from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Complexes, Integers, Progress, Reals
from ..core.value import plain, quoted
from ..mesh.checks import check_memory_limit, check_options, checked_coefficients, only_component, own_vertices
from ..mesh.edges import edge_keys, edges_of_keys
from ..mesh.surface import Surface
from ..tiling.request import part_of
from .form_structure import FormStructure
from .results import result


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
        options = {"solver": solver, "threads": count, "memory_limit": limit, "progress": progress}
        core = _native.automatic_structure(part_of(surface, component), **options)
        made = pole_structure_of(core, surface, component, count)
    own = np.array(poles).tolist() if vertices else None  # the caller's list may change
    options = {"solver": solver, "threads": threads, "memory_limit": memory_limit}
    return made.computed_by(partial(log_map, surface, own, given or None, **options))


def _residues(residues):
    try:
        return [] if residues is None else [complex(r) for r in residues]
    except (TypeError, ValueError, OverflowError) as error:
        raise TopologyError(f"residues must be a list of numbers, not {quoted(residues)}") from error


@dataclass(frozen=True, eq=False, repr=False)
class PoleStructure(FormStructure):
    """Result of `log_map`: a surface of genus g with poles p_i.

    The first form, theta_0, is a differential of the third kind: around p_i the UVs change by the residue r_i (that is,
    theta_0 has the residue r_i / (2 pi i) there); for real residues all its periods are real, so v is single-valued.
    Every face is kept: in the star of a pole, which lies at infinity, each triangle has an apex of its own, placed
    by the similarity that fits its outer side.

    The holomorphic forms of the surface come after theta_0: g on a closed surface, where the residues sum to 0, and
    2g + b - 1 with b boundary loops. There, for real residues and coefficients, v is constant along each loop, which
    becomes a straight line.

    All of it belongs to the surface's own triangles; in a polygon at a pole the diagonals are flipped away from it.
    """

    map_kind = "log"

    @cached_property
    def description(self) -> str:
        """What was made, in one phrase."""
        names = [str(p) for p in self.poles]
        ends = f"poles at {', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else f"a pole at {names[0]}"
        usual = [1, -1] if self._component.boundary_count == 0 else np.ones(len(names))
        if not np.array_equal(self.residues, usual):
            ends += f", residues {', '.join(_text(r) for r in self.residues)}"
        forms = self._differentials.shape[1] - 1
        more = "" if forms == 0 else f" and {forms} holomorphic form{'s' if forms > 1 else ''}"
        return f"{'differential' if self._component.genus else 'log map'}{more} with {ends}"

    @cached_property
    def poles(self) -> Integers:
        """(k,) vertices."""
        return self._of_surface(self._native.poles())

    @cached_property
    def residues(self) -> Complexes:
        """(k,) complex residues: by how much the UVs change around each pole, counter-clockwise."""
        return self._native.residues()

    def balanced_coefficients(self, progress: Progress | None = None) -> Complexes:
        """(n,) complex coefficients of theta_0 alone, which keeps its residues."""
        return arrays.frozen(np.eye(1, self._differentials.shape[1], dtype=np.complex128)[0])

    def sphere_map(self) -> Reals:
        """(#V, 3) points of the unit sphere: the conformal map of a surface of genus 0 with two poles, the first at
        (0, 0, 1), the second at (0, 0, -1), NaN at isolated vertices. Moebius maps along the axis are free: the mean
        height over the surface's area is 0.

        Raises TopologyError for another genus or number of poles."""
        return self._at_vertices(self._native.sphere_map())

    def invariants(self) -> dict[str, Any]:
        """The poles and their residues, as plain data: no other invariants are computed."""
        return plain({"poles": self.poles, "residues": self.residues})


def _text(residue):
    if residue.imag == 0:
        return f"{residue.real:g}"
    return f"{residue.real:g}{residue.imag:+g}i"


def pole_structure_of(core, surface, component, threads):
    """The `PoleStructure` that the core made."""
    made = result(TruncatedStructure if core.is_truncated else PoleStructure, surface, component, core.solved, threads)
    vars(made)["_core"] = core
    return made


@dataclass(frozen=True, eq=False, repr=False)
class TruncatedStructure(PoleStructure):
    """`PoleStructure` of a mesh whose poles' stars meet. It was solved on the mesh with the corners at its poles cut
    off (native/src/choice/truncated.h); UVs are those of the remaining corners, and the corners that were cut off are
    put back by a similarity."""

    @cached_property
    def _core(self):
        return self._solution.compute()._core

    @cached_property
    def _triangulation(self):
        return self._component._native

    @cached_property
    def holomorphic_forms(self):
        """(1, #E) complex: theta_0, NaN on the edges that end at a pole."""
        z = np.ascontiguousarray(self.uv(self.balanced_coefficients())).view(np.complex128)[:, 0]
        triangles, corners = self._component.triangles, self._component.triangle_corners
        start, end = triangles.ravel().astype(np.int64), np.roll(triangles, -1, axis=1).ravel().astype(np.int64)
        tails, heads = z[corners.ravel()], z[np.roll(corners, -1, axis=1).ravel()]
        edges, count = self._component._native.edges, len(self._component.vertex_index)
        found = edges_of_keys(edges, edge_keys(np.stack([start, end], axis=1), count), count)
        values = np.empty(len(edges), complex)
        values[found] = np.where(start < end, heads - tails, tails - heads)  # from the lower vertex to the higher
        values[np.isin(edges, self._native.poles()).any(axis=1)] = np.nan
        return arrays.frozen(values[None])

    @cached_property
    def seams(self):
        """(#S,) indices into `edges` where the UVs of the two sides differ."""
        return self._core.seams(self._threads)

    def uv(self, coefficients):
        """(#C, 2) UVs of c_0 theta_0, from one complex coefficient."""
        return self._core.uv(checked_coefficients(coefficients, 1, np.complex128), self._threads)

    def sphere_map(self):
        """(#V, 3) points of the unit sphere; see `PoleStructure.sphere_map`."""
        count = len(self._component.vertex_index)
        return self._at_vertices(arrays.frozen(self._native.sphere_map()[:count].copy()))
