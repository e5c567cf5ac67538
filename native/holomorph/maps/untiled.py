"""The maps of a part without whole tiles: the balanced one of its structure, and flat islands."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from ..core.array_types import Progress
from ..core.progress import scaled
from ..core.value import counted
from ..cutting.island_layout import Islands
from ..cutting.island_map import EVENED, HARD, IslandSearch, one_island
from ..mesh.hard_edges import TIP, breaks, curvature
from ..mesh.surface import Surface
from ..quality.appearance import of_squares
from ..tiling.tilings import Tiling
from .automatic_structure import AnyStructure
from .map import Map, form_map
from .tiling_search import REFUSALS

GOOD = 0.8  # what islands may cost (see `appearance`) to be taken at once: less than a tiling does with poles
FLAT = 0.3  # what is minded of squares that hardly differ
POOR = 2.4  # cost of a map, from which on islands are looked for whatever the curvature
MOST_SOFT = 0.02  # length of a seam across the smooth over the square root of the area, that is not minded

MOST_CURVED = 8 * math.pi  # curvature off hard edges, that of two spheres: where there is more, islands have long seams

# The work on a tiling, in millionths of about a second, for each triangle of the level on which poles are placed, and
# of the part; how much of it is spent on islands where there is a tiling, and what is spent on them in any case.
PLACED, LEVEL, ROUNDED = 40, 10_000, 8
BUDGET, LEAST_WORK = 0.4, 100_000


class Untiled:
    """The maps of a part without whole tiles, each made when it is asked for, once. There are no islands where they
    collapse, as where all faces lie on lines: on a smooth part they take longer than a tiling, and cost more."""

    def __init__(
        self, surface: Surface, structure: AnyStructure, evenness: float, is_upright: bool, threads: int | None = None
    ) -> None:
        self.surface, self._structure, self._evenness, self._is_upright = surface, structure, evenness, is_upright
        self._conformal: Map | None = None
        has_islands = surface.vertices is not None and surface.area > 0
        self._search = IslandSearch(surface, evenness, threads or 0, is_upright) if has_islands else None

    @property
    def known(self) -> Islands | None:
        """The best islands so far, if they were looked for."""
        return self._search and self._search.known

    def conformal(self, progress: Progress | None) -> Map:
        """The balanced map, not evened."""
        if self._conformal is None:
            step = scaled(progress, 1.0, 1.0)
            self._conformal = form_map(self.surface, self._structure, upright=self._is_upright, progress=step)
        return self._conformal

    def at_once(self, progress: Progress | None) -> Map | None:
        """The islands that cost so little that hardly another map costs less, if there are any, or better ones."""
        flat = self._asked(lambda search: search.at_once(GOOD, progress)) if self._may_flatten else None
        if flat is not None and of_squares(flat.quality) > FLAT:
            flat = self._asked(lambda search: search.best(flat.cost, self._work, progress)) or flat
        return flat and self._map(flat)

    def islands(self, most: float, progress: Progress | None, work: float | None = None) -> Map | None:
        """The islands of least cost, if it is below `most`, and they are found by so much work; default: a part of the
        work on a tiling."""
        if work is None and most < POOR and not self._may_flatten:
            return None
        work = self._work if work is None else work
        flat = self._asked(lambda search: search.best(most, work, scaled(progress, 1.0, 1.0)))
        return flat and self._map(flat)

    def instead(self, why: str, progress: Progress | None) -> Map | None:
        """The islands, however long they take, where no other map is tried."""
        flat = self._asked(lambda search: search.best(math.inf, math.inf, scaled(progress, 1.0, 1.0)))
        return flat and self._map(flat, f"it has {why}; {_how(flat)}")

    def balanced(self, most: float, why: str, progress: Progress | None) -> Map | None:
        """The balanced map, if it costs less than `most`. It is evened only where that may bring it there."""
        conformal = self.conformal(progress)
        least = conformal.cost
        if self._evenness > 0 and math.isfinite(least):
            least -= (1 - EVENED) * of_squares(conformal.quality)
        if not least < most:
            return None
        made = self._balanced(why, progress)
        return made if made.cost < most else None

    def best(self, why: str, progress: Progress | None) -> Map:
        """The one of least cost, however long islands take."""
        made = self._balanced(why, progress)
        return self.islands(made.cost, progress, math.inf) or made

    def one_island(self, tiling: Tiling, why: str) -> Map | None:
        """A tiling scaled to the wanted size, as one island with its seams; None on an intrinsic surface."""
        return None if self.surface.vertices is None else self._map(one_island(self.surface, tiling), why)

    def _balanced(self, why, progress):
        options = {"evenness": self._evenness, "upright": self._is_upright, "progress": scaled(progress, 1.0, 1.0)}
        return form_map(self.surface, self._structure, why=why, **options)

    def _map(self, flat, why=""):
        return Map(self.surface, self._structure, flat.uv, flat.quality, np.empty(0), why or _how(flat), islands=flat)

    def _asked(self, ask):
        try:
            found = self._search and ask(self._search)
        except REFUSALS:
            return None  # another map may be made
        return found if found and math.isfinite(found.cost) else None

    @cached_property
    def _may_flatten(self):
        if self._search is None:
            return False
        return curvature(self.surface, breaks(self.surface) > np.radians(HARD[-1]), TIP) <= MOST_CURVED

    @property
    def _work(self):
        count = len(self.surface.triangles)
        return LEAST_WORK + BUDGET * (PLACED * min(count, LEVEL) + ROUNDED * count)


def _how(flat):
    """How it is flattened, in one sentence."""
    where = "hard edges" if flat.soft_length <= MOST_SOFT else "seams"
    what = "in one piece" if not len(flat.seams) else f"along its {where} into {counted(flat.count, 'piece')}"
    return f"it flattens {what}: size range {flat.quality.size_range:.3g}"
