# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail as arrays. No bpy here: it runs in a worker thread."""

from dataclasses import dataclass, field

import numpy as np

from .. import native
from ..maps import mapped
from ..maps.mapped import BALANCED, MappedObject, Request
from ..native import holomorph
from ..solving import jobs

SOLVE_PART = 0.5  # share of the whole work, where a map has to be made first
COLLAPSE_PART = 0.8  # share of the rest; then the maps are transferred


@dataclass(frozen=True)
class LevelOptions:
    """How many levels, and how coarse each one is."""

    levels: int = 4
    ratio: float = 0.25  # triangles of a level over those of the one before

    def counts(self, triangles):
        """Numbers of triangles, finest level first."""
        return [max(1, round(triangles * self.ratio ** (k + 1))) for k in range(self.levels)]


@dataclass
class LevelsWork(jobs.Work):
    """Makes the levels of one mesh; a map of its own first where there is none.

    After `run`, `levels` are the `holomorph.LevelOfDetail`s, finest first, each coarser than the one before; `names`
    are those of their maps; `mapped` is the `mapped.MappedObject` that was needed.
    """

    task: object  # jobs.Task
    names: list  # names of the maps that are transferred
    uv: np.ndarray  # (#C, m, 2), in the order of the polygons' corners
    turns: list  # of each map
    needs_map: bool
    options: LevelOptions
    progress: object = None
    levels: list = field(default_factory=list)
    mapped: object = None

    def __post_init__(self):
        super().__init__(self.progress)

    def work(self):
        start = SOLVE_PART if self.needs_map else 0.0
        if self.needs_map:
            solved = jobs.solve(self.task, self.watch.part(0, start))
            wanted = MappedObject(Request("balanced"), main=BALANCED, forms=0, solved=solved)
            (self.mapped,) = mapped.mapped([wanted])
            self._add_main_map()
        surface = self.task.polygons.surface()
        if not self.names:
            return
        collapsed = start + (1 - start) * COLLAPSE_PART
        levels = native.module("levels.levels")
        cones = [levels.cones(surface, self.uv[:, k], turns) for k, turns in enumerate(self.turns) if turns != 1]
        kept = np.concatenate([np.empty(0, np.int64), *cones])
        mesh = holomorph.ProgressiveMesh(surface, kept=kept, progress=self.watch.part(start, collapsed))
        counts = self.options.counts(len(surface.triangles))
        if not self.watch(collapsed, "levels of detail"):
            raise holomorph.Cancelled("cancelled before the levels of detail")
        made, before = [], len(surface.triangles)
        for level in mesh.levels_of_detail(self.uv, counts, turns=self.turns):
            if len(level.surface.triangles) < before:
                made.append(level)
                before = len(level.surface.triangles)
        self.levels = made

    def _add_main_map(self):
        """Bit for bit the one that is written to the object as well."""
        if self.mapped.done:
            name, values = next(self.mapped.maps())
            self.names, self.turns = [*self.names, name], [*self.turns, 1]
            self.uv = np.concatenate([self.uv, values[:, None].astype(np.float64)], axis=1)
