"""Log maps of meshes so coarse that the stars of any two vertices meet: cones, pyramids, tetrahedra."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import _native
from ..core import arrays
from ..mesh.checks import checked_coefficients
from ..mesh.edges import edge_keys, edges_of_keys
from ..tiling.request import part_of
from .pole_structure import PoleStructure
from .results import result


def sphere_structure(surface, component, solver, threads, memory_limit, progress):
    """The `PoleStructure` of a closed surface of genus 0 with poles that the core chooses."""
    options = {"solver": solver, "threads": threads, "memory_limit": memory_limit, "progress": progress}
    return pole_structure_of(
        _native.automatic_structure(part_of(surface, component), **options), surface, component, threads
    )


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
