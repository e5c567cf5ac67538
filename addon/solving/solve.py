# SPDX-License-Identifier: GPL-3.0-or-later
"""From polygons to the conformal structures of their parts. No bpy here: it runs in a worker thread."""

import hashlib
import itertools
import time
from dataclasses import dataclass, field

import numpy as np

from ..native import holomorph
from .choices import Choices, structures

DOUBLE = 8  # bytes
DOUBLES_OF_TILER = 40  # for each edge: half-edges, weights, the multigrid hierarchy
DOUBLES_OF_MAP = 6  # for each corner: UVs and quality
KEPT_MAPS = 4  # maps kept for each object: the redo panel goes back and forth between a few
# Solves, so that the dials of the redo panel cost one small matrix product and no solve: an object that was moved,
# renamed, undone or reopened has the same, one that was edited has not.
KEPT = holomorph.core.newest.Kept(1_200_000_000)


@dataclass(frozen=True)
class Task:
    """A mesh to solve, and what was chosen on it."""

    polygons: object
    chosen: Choices = Choices()

    @property
    def key(self):
        """Equal for tasks with the same result: of the same geometry and topology, with the same choices."""
        digest = hashlib.sha256()
        for array in (self.polygons.vertices, self.polygons.corner_vertices, self.polygons.face_offsets):
            digest.update(f"{array.shape}".encode())
            digest.update(np.ascontiguousarray(array))
        return digest.digest(), self.chosen.key


@dataclass(frozen=True, eq=False)
class SolvedObject:
    """The parts of one object in the library's order, the mesh as given, and the surface in it."""

    surface: object
    polygons: object
    components: list  # `PartStructure`s of the package
    seconds: float
    # What `mapped` made of it by what was asked, newest last: the `mapped.MappedPart`s, and a size for them.
    maps: dict = field(default_factory=dict)
    number: int = field(default_factory=itertools.count().__next__)  # no other one has it

    @property
    def done(self):
        """The components that have maps."""
        return [c for c in self.components if c.structure is not None]

    @property
    def form_count(self):
        """The largest number of forms among the components."""
        return max((c.form_count for c in self.components), default=0)

    def keep_maps(self, asked, made):
        """Adds those of the `done` components, and drops the oldest beyond `KEPT_MAPS`."""
        self.maps[asked] = made
        while len(self.maps) > KEPT_MAPS:
            del self.maps[next(iter(self.maps))]

    @property
    def nbytes(self):
        """About how many bytes are held: harmonic forms and potentials; of tilers also solvers; and maps."""
        has_tilings = any(part.tiling for parts, _ in self.maps.values() for part in parts)
        per_form, per_edge = (6, 4 + DOUBLES_OF_TILER) if has_tilings else (4, 4)
        of_edges = sum((per_form * c.form_count + per_edge) * len(c.structure.edges) for c in self.done)
        corners = sum(len(c.surface.corner_vertices) for c in self.done)
        return DOUBLE * (of_edges + len(self.maps) * DOUBLES_OF_MAP * corners)


def solve(task, progress=None):
    """The `SolvedObject`, kept or new; a new one is kept.

    progress(fraction, stage) returning False cancels. Raises `holomorph.Error` for a mesh that cannot be treated as a
    whole, and where an explicit choice of vertices does not fit the part they lie on.
    """
    key = task.key
    return KEPT.get(key) or KEPT.keep(key, solved_anew(task, progress))


def solved_anew(task, progress=None):
    """The `SolvedObject`, which is not kept."""
    start, polygons = time.perf_counter(), task.polygons
    arrays = polygons.vertices, polygons.corner_vertices, polygons.face_offsets
    surface, parts = structures.chosen_structures(*arrays, task.chosen, progress)
    polygons.share(surface)
    return SolvedObject(surface, polygons, parts, time.perf_counter() - start)
