# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves in a thread of the library, on copies of the arrays: no bpy in here, so Blender's window stays alive.

A call of the library takes seconds or minutes, while Blender's timers run between calls alone; they look at the work.
"""

import hashlib
import itertools
import time
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..native import holomorph, module

structures = module("maps.chosen_structures")

NONE, POLES, RECTANGLE = structures.NONE, structures.POLES, structures.RECTANGLE  # what the selection is
AUTOMATIC, NO_EDGES, Choices = structures.AUTOMATIC, structures.NO_EDGES, structures.Choices
# Which faces are mapped: all; in edit mode the selected ones if there are any; these, or a refusal.
WHOLE, SELECTED, ASKED = "WHOLE", "SELECTED", "ASKED"
DOUBLE = 8  # bytes
DOUBLES_OF_TILER = 40  # for each edge: half-edges, weights, the multigrid hierarchy
DOUBLES_OF_MAP = 6  # for each corner: UVs and quality
KEPT_MAPS = 4  # maps kept for each object: the redo panel goes back and forth between a few
REFUSALS = holomorph.Error, MemoryError  # with which a mesh is refused; their sentences are for the user


class Kept(dict):
    """Values by their keys, that which was asked for last at the end: `limit` bytes at most by their `nbytes`, but
    always the last one."""

    def __init__(self, limit):
        super().__init__()
        self.limit = limit

    def get(self, key):
        """The value of a key; None where it is not kept."""
        if key in self:
            self[key] = self.pop(key)  # in one line: an error between two would lose it
        return super().get(key)

    def keep(self, key, value):
        """Keeps the value, and returns it."""
        self[key] = value
        self.trim()
        return value

    def trim(self):
        """Drops values beyond the limit. For the caller where values have grown."""
        while len(self) > 1 and sum(value.nbytes for value in self.values()) > self.limit:
            del self[next(iter(self))]


# Solves, so that the dials of the redo panel cost one small matrix product and no solve: an object that was moved,
# renamed, undone or reopened has the same, one that was edited has not.
KEPT = Kept(1_200_000_000)


@dataclass(frozen=True)
class Task:
    """A mesh to solve, and what was chosen on it."""

    polygons: object
    chosen: Choices = Choices()

    @cached_property
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

    @cached_property
    def done(self):
        """The components that have maps."""
        return [c for c in self.components if c.structure is not None]

    @cached_property
    def form_count(self):
        """The largest number of forms among the components."""
        return max([c.structure.form_count for c in self.done], default=0)

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
        of_edges = sum((per_form * c.structure.form_count + per_edge) * len(c.structure.edges) for c in self.done)
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


class Work:
    """Work that the library runs in a thread and that can be cancelled: after `cancel()` it ends at the library's next
    call of `watch`, and nothing more is solved or kept. Subclasses define `work`; one of `REFUSALS` that ends it is
    the `error`.

    progress : is told the fraction that is done
    """

    def __init__(self, progress=None):
        self.watch = holomorph.core.progress.Watch(progress)
        self.error = None
        self._future = None

    def start(self):
        self._future = holomorph.core.progress.in_background(self.run)

    def cancel(self):
        self.watch.cancel()

    def is_running(self):
        return self._future is not None and not self._future.done()

    def wait(self):
        """Waits for the end, and raises what went wrong unexpectedly: anything but a refusal is a bug of ours."""
        if self._future is not None:
            self._future.result()

    def run(self):
        """Works here and now, in the calling thread."""
        try:
            self.work()
        except REFUSALS as error:
            self.error = error


class Job(Work):
    """Solves a list of `Task` one after the other, and then goes on with all solves as the function `then` does,
    if there is one: from {i: SolvedObject} of `tasks[i]`, and a progress function, it makes {i: result}.

    `results[i]` is that, or the `SolvedObject`; or the error that refused the mesh, one of `REFUSALS`.
    """

    SOLVE_SHARE = 0.3  # part of the work where something follows

    def __init__(self, tasks, progress=None, then=None):
        super().__init__(progress)
        self.results = [None] * len(tasks)
        self._tasks, self._then = tasks, then

    def work(self):
        share = self.SOLVE_SHARE if self._then else 1.0
        made = self._solved(share)
        if self._then and made and not self.watch.is_cancelled:
            made = self._followed(made, share)
        for index, result in made.items():
            self.results[index] = result

    def _followed(self, solved, share):
        try:
            return self._then(solved, self.watch.part(share, 1.0))
        except REFUSALS as error:
            return dict.fromkeys(solved, error)
        finally:
            KEPT.trim()  # tilers and maps are part of the solves

    def _solved(self, share):
        """{i: SolvedObject}, until the job is cancelled; refusals become results."""
        count, made = len(self._tasks), {}
        for index, task in enumerate(self._tasks):
            if self.watch.is_cancelled:
                break
            try:
                made[index] = solve(task, self.watch.part(share * index / count, share * (index + 1) / count))
            except REFUSALS as error:
                self.results[index] = error
        return made
