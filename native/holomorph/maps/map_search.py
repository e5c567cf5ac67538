"""Which map a part gets: the one that an eye minds least. What may cost less than the best so far is tried."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ..core.array_types import Progress
from ..core.progress import scaled
from ..core.value import quoted
from ..mesh.checks import checked_evenness
from ..quality.appearance import of_squares
from ..tiling.turned import LATTICE
from .automatic_structure import automatic_structure
from .budget import Budget
from .late_structure import LateStructure, late_structure
from .map import Map, form_map
from .piece_search import EXACT, PieceSearch
from .request import MAIN_MAPS, Request
from .size import TRIES, Window, is_in, nearest, relative_size, window_around
from .tiling_search import REFUSALS, Refusal, TilingSearch
from .untiled import FLAT, GOOD, MOST_SOFT, POOR, Untiled

TILING = 0.8  # part of the work, where pieces follow
TOO_FEW = "too few whole tiles fit on it for squares of the wanted size"
SHORT = "not all was tried, as it would take long"
PIECES = 2.0  # times the budget, within which pieces follow a tiling: where there are hard edges they are often better
ISLANDS = 1e-4  # millionths of a second for each operation of a tiling that takes long: about a tenth of its time
FAR = 10.0  # times the budget: what takes longer is not tried where there is another map, however poor


class MapSearch:
    """The maps of one part by its `Request`. Its structure is made at once, and what is found at once; other maps when
    a size is asked for.

    budget : shared with another search of the same part

    Raises what `automatic_structure` raises.
    """

    def __init__(
        self,
        request: Request,
        threads: int | None = None,
        progress: Progress | None = None,
        budget: Budget | None = None,
    ) -> None:
        if request.main not in MAIN_MAPS:
            raise ValueError(f"main is {quoted(request.main)}; one of {', '.join(MAIN_MAPS)} is needed")
        checked_evenness(request.evenness)
        surface, self._request, self._threads = request.surface, request, threads
        structure = request.structure or late_structure(surface, threads)
        self._budget = budget or Budget(len(surface.triangles), request.effort)
        self.final: Map | None = None
        if isinstance(structure, LateStructure):
            self.final = self._instead(structure, progress)
            if self.final:
                return
            structure = structure.made
        with self._budget:
            structure = structure or automatic_structure(surface, threads=threads, progress=progress)
            self._structure = structure
            self._tilings = TilingSearch(surface, structure, request, self._budget)
            self._untiled = Untiled(surface, structure, request.evenness, request.is_upright, threads)
            self._pieces: PieceSearch | None = None
            self._flat: Map | None = None
            self.final = self._final(scaled(progress, 1.0, 1.0))

    def _instead(self, structure, progress):
        """The islands of a part whose forms would take too long, where these are not asked for."""
        asked = self._request
        if asked.main not in ("automatic", "untiled") or not isinstance(asked.poles, str):
            return None
        untiled = Untiled(asked.surface, structure, asked.evenness, asked.is_upright, self._threads)
        return untiled.instead(structure.description, progress)

    def _final(self, progress):
        """The map where no other is tried."""
        main, surface, structure = self._request.main, self._request.surface, self._structure
        if main == "balanced":
            coefficients, evenness = self._request.coefficients, self._request.evenness
            upright = self._request.is_upright and structure.form_count == 0  # coefficients are as they were given
            return form_map(surface, structure, coefficients, evenness=evenness, upright=upright, progress=progress)
        if main == "untiled":
            return self._untiled.best("it has no tiling", progress)
        if main == "seamless":
            return None
        if surface.area == 0:
            return form_map(surface, structure, why="the surface has no area", evenness=self._request.evenness)
        self._flat = self._untiled.at_once(progress)
        return self._flat if self._flat and not self._may_be_better(self._flat.islands) else None

    def maps(self, density: float, tries: int, leads: bool, progress: Progress | None) -> Sequence[Map]:
        """The map of least cost; where that is a tiling, the ones with all the numbers of tiles that were tried.

        tries : numbers of tiles; leads : whether the density may be another one, of which whole tiles are nearer

        Raises what refuses a tiling that was asked for.
        """
        if self.final:
            return [self.final]
        with self._budget:
            return self._tried(density, tries, leads, progress)

    def _tried(self, density, tries, leads, progress):
        best, tilings = self._flat, []
        is_long = self._is_long
        if is_long:
            best = self._quick(density, tries if leads else 0, progress) or best
            times = FAR if best and best.cost >= POOR else 1.0
            if best and not self._budget.goes_on(self._tilings.expected_work, times):
                return [self._said(best)]
        if best is None or self._is_ring or best.cost > GOOD:
            tilings, why = self._whole(density, tries, scaled(progress, 0.0, TILING))
            if self._request.main == "seamless":
                return tilings
            best = self._least(best, tilings and nearest(tilings, density), why, scaled(progress, TILING, TILING))
        if not is_long:  # else they were tried
            tries, step = tries if leads else 0, scaled(progress, TILING, 1.0)
            best = self._in_pieces(best, density, tries, window_around(), step) or best
        return [self._said(made) for made in (tilings if best in tilings else [best])]

    @property
    def _is_long(self):
        """Whether a tiling of the whole part, that may be left out, takes more than there is."""
        is_open = self._request.main != "seamless" and not self._tilings.is_strict
        return is_open and not self._budget.allows(self._tilings.expected_work)

    def _quick(self, density, tries, progress):
        """The best of the maps that take less than a tiling of the whole part."""
        work = self._tilings.expected_work * ISLANDS
        islands = self._untiled.islands(math.inf, scaled(progress, 0.0, 0.0), work)
        best = min((made for made in (self._flat, islands) if made), key=lambda made: made.cost, default=None)
        return self._in_pieces(best, density, tries, window_around(), progress) or best

    def _said(self, made):
        """The map, which says where others were not tried."""
        return replace(made, why=f"{made.why}; {SHORT}") if self._budget.was_short else made

    def _whole(self, density, tries, progress):
        """(The tilings of the whole part, why another map is better)."""
        try:
            return self._tilings.of_density(density, tries, progress), "a tiling would look worse"
        except REFUSALS as error:
            if self._request.main == "seamless":
                raise
            return [], f"no tiling can be made: {error}"

    def _least(self, flat, tiling, why, progress):
        """The one of least cost among these and the other maps of the whole part."""
        found = [made for made in (flat, tiling) if made]
        best = min(found, key=lambda made: made.cost, default=None)
        is_poor = best is None or best.cost >= POOR
        if best and not self._budget.goes_on(times=FAR if is_poor else 1.0):
            return best
        best = self._untiled.balanced(best.cost if best else math.inf, why, progress) or best
        if best is None:
            return self._untiled.best(why, progress)
        if flat is not None and flat.cost <= GOOD:
            return best
        return self._untiled.islands(best.cost, progress, math.inf if is_poor else None) or best

    def fitted(
        self, found: Sequence[Map] | Refusal, density: float, window: Window, near: float, progress: Progress | None
    ) -> Map:
        """The tiling of `maps` that is in the window, or stretched to the density, or turned until it is in the
        window; else the best other map, or a tiling whose density is as near as `SizePolicy.near` says. What is asked
        for explicitly, such as poles that are chosen or moved, is made with another density. Raises what refuses
        it."""
        with self._budget:
            return self._fitting(found, density, window, near, progress)

    def _fitting(self, found, density, window, near, progress):
        if isinstance(found, Exception):
            if self._tilings.is_strict or not isinstance(found, REFUSALS):
                raise found
            return self._untiled.best(str(found), progress)
        inside = [made for made in found if is_in(window, relative_size(made, density))]
        made = nearest(inside or found, density)
        if made.mixed and not inside:
            return self._in_pieces(None, density, 0, EXACT, progress) or made
        if not made.tiling:
            return made
        if inside or self._tilings.is_strict:
            made = self._tilings.moved(inside or found, density, True, progress)
            return made if inside else self._tilings.stretched(made, density) or made
        if made.turns != 1:
            others = [self._less_bound(made, density, window, near, progress)]
        elif fitting := self._fitted(made, density, window, progress):
            return fitting
        else:
            others = [self._untiled.best(TOO_FEW, progress), self._untiled.one_island(made.tiling, TOO_FEW)]
        close = [one for one in found if abs(relative_size(one, density) - 1) <= near]
        return min(filter(None, others + close), key=lambda one: one.cost + _missed(one, density, window))

    def _less_bound(self, made, density, window, near, progress):
        """As `fitted`, of maps without lines, or of those that do not turn: these have more sizes."""
        has_lines = made.tiling.lines != "none"
        less = {"lines": "none"} if has_lines else {"turns": 1, "lattice": LATTICE[made.turns]}
        request = replace(self._request, structure=self._structure, options={**self._request.options, **less})
        search = MapSearch(request, self._threads, budget=self._budget)
        found = search.maps(density, TRIES, False, scaled(progress, 0.0, 0.5))
        return search.fitted(found, density, window, near, scaled(progress, 0.5, 1.0))

    def about(self, density: float, tries: int, progress: Progress | None) -> Map:
        """The map whose density is the nearest that this many numbers of tiles give."""
        found = self.maps(density, tries, True, progress)
        return self._tilings.moved(found, density, tries > 1, progress) if found[0].tiling else found[0]

    def _fitted(self, made, density, window, progress):
        """The tiling stretched to the density, or turned until it is in the window; None where it is neither."""
        stretched = self._tilings.stretched(made, density)
        if stretched and not self._has_rival(stretched, progress):
            return stretched
        turned = self._tilings.turned(density, progress)
        return turned if turned and is_in(window, relative_size(turned, density)) else None

    def _has_rival(self, made, progress):
        if self._request.main == "seamless" or not self._budget.goes_on():
            return False
        return bool(self._untiled.balanced(made.cost, "", progress) or self._untiled.islands(made.cost, progress))

    def _in_pieces(self, rival, density, tries, window, progress):
        if self._tilings.is_strict or not self._may_be_better(self._untiled.known):
            return None
        if rival and rival.tiling and not self._budget.goes_on(times=PIECES):
            return None
        if self._pieces is None:
            self._pieces = PieceSearch(self._request, self._structure, self._untiled.known, self._budget, self._threads)
        return self._pieces.best(rival, density, tries, window, progress)

    def _may_be_better(self, flat):
        """Whether islands have a seam across the smooth, or squares that differ, or there are none."""
        if self._request.surface.vertices is None:
            return False
        return flat is None or flat.soft_length > MOST_SOFT or of_squares(flat.quality) > FLAT

    @property
    def _is_ring(self):
        """Whether it may need no poles."""
        surface = self._request.surface
        return (surface.genus, surface.boundary_count) in ((0, 2), (1, 0))


def _missed(made, density, window):
    """The cost of squares of another size than on other parts: as between those of one part (`appearance`)."""
    size = relative_size(made, density)
    return abs(math.log(size)) if made.is_tiled and not is_in(window, size) else 0.0
