"""The tilings of a part, of a wanted density: the numbers of poles and of tiles that give it."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .._native import InvalidMesh, SolverError, TopologyError
from ..core import arrays
from ..core.array_types import Progress
from ..core.progress import scaled
from ..core.value import percent
from ..mesh.surface import Surface
from ..quality.appearance import of_direction
from ..quality.quality import Quality
from ..tiling.tilings import Tiling, generators
from ..tiling.turned import AUTOMATIC, EDGED, LATTICE, LINED_TURNS, MIRROR, are_whole, lines_of
from .arrangement import on_grid
from .automatic_structure import AnyStructure
from .budget import Budget
from .map import Map
from .request import Request
from .size import is_in, nearest, relative_size, window_around

REFUSALS = InvalidMesh, TopologyError, SolverError  # what is said about one part, others go on
Refusal = InvalidMesh | TopologyError | SolverError

MOST_LOST = 0.02  # part of the area that a tiling may flip or let collapse: more is seen

# What remains of the cost of the density that poles allow, once squares are rounded to whole tiles and evened, as it
# was seen on some thirty meshes: about.
ROUNDED = 0.9

# The evened size range above which two more poles are tried, where that is quick, and tiles are so many that their
# rounding decides less than the poles.
UNEVEN, MORE_POLES, MOST_POLES, FEW_TRIANGLES, MANY_TILES = 1.73, 2, 16, 5000, 60

# Cost of a tiling without poles, expected and made, up to which the best map has no cones: all of its rows run round.
REGULAR = 1.1

POOR_TURNED = 2.0  # cost of a tiling that turns, above which one that is only shifted is tried: most cost 0.7 to 1.8

# What rows that run along hard edges, and end there, are worth in the cost, which does not see them: for lines as long
# as the square root of the area, and at most. They are tried where there are as many, and up to so many triangles:
# objects that are made of such edges have few.
LINED, MOST_LINED, MOST_LINED_TRIANGLES = 0.1, 0.3, 20_000

# The work on a tiling for each triangle, of so many at least, with few loops: so many double it, by their square.
TRIANGLE, FEW, FEW_LOOPS = 1e5, 4000, 20

MOST_TURNED = 0.5  # radians from the direction that is asked for, where no whole tiles of one size are nearer to it
MOST_STRETCHED = 1.35  # factor: whole tiles around a limb, from three on, are never further from the wanted size
ALONG = 1e-9  # sine of an angle that is rounding


class TilingSearch:
    """The tilings of a part by what is asked for: poles, and other options of `Structure.tile`. Poles are placed once.

    surface : the part; or a piece of it, whose vertices poles are named by
    structure : its conformal structure
    """

    def __init__(self, surface: Surface, structure: AnyStructure, request: Request, budget: Budget) -> None:
        self.surface, self._structure, self._request, self._budget = surface, structure, request, budget

    @property
    def is_strict(self) -> bool:
        """Whether more is asked of a tiling than its density."""
        options = self._request.options
        is_chosen = not (self._is_open or self._has_no_poles)
        is_bound = any(options.get(name) is not None for name in ("max_added", "allowed"))
        return is_chosen or is_bound or bool(options.get("moves")) or self._has_cones

    @property
    def expected_work(self) -> float:
        """About what a tiling takes, in what `Budget` counts: as was seen on parts of 5,000 to 60,000 triangles."""
        loops = max(2 * self.surface.genus + self.surface.boundary_count - 1, 0)
        return TRIANGLE * max(len(self.surface.triangles), FEW) * (1 + (loops / FEW_LOOPS) ** 2)

    def guess_without_poles(self, progress: Progress | None = None) -> float:
        """About what a tiling without poles costs, of which only the density is known."""
        boundary = self._request.options.get("boundary", "automatic")
        options = {"evened": self._request.evenness > 0, "surface": self.surface, "boundary": boundary}
        tiler = self._structure.tiler(0, **options, progress=scaled(progress, 0.0, 0.0))
        return 2 * ROUNDED * math.log(max(tiler.poles.size_range, 1.0))

    def of_density(self, density: float, tries: int, progress: Progress | None) -> list[Map]:
        """The tilings that this many numbers of tiles give, until the density is the wanted one. Raises what refuses
        the first one."""
        tilings: list[Map] = []
        tiles, below, above = density * self.surface.area, 0.0, math.inf
        for attempt in range(tries):
            if tilings and not self._budget.goes_on():
                break
            step = scaled(progress, attempt / tries, (attempt + 1) / tries)
            try:
                tilings.append(self._of_tiles({"tiles": tiles or None, "size_counts": tries > 1}, step))
            except REFUSALS:
                if not tilings:
                    raise
                break
            size = relative_size(tilings[-1], density)
            if is_in(window_around(), size):
                break
            below, above = (max(below, tiles), above) if size < 1 else (below, min(above, tiles))
            tiles /= size
            if not below < tiles < above:  # the density grows in steps
                tiles = math.sqrt(below * above)
        return tilings

    def moved(self, tilings: Sequence[Map], density: float, size_counts: bool, progress: Progress | None) -> Map:
        """The one whose density is nearest, with the poles moved that are to be moved after the rounding."""
        made = nearest(tilings, density)
        if not self._request.options.get("moves"):
            return made
        size = {"tiles": made.tiling.tiles, "size_counts": size_counts, "moves": self._request.options["moves"]}
        return self._of_tiles(size, scaled(progress, 1.0, 1.0))

    def stretched(self, made: Map, density: float) -> Map | None:
        """The tiling stretched to a density; None where it cannot be."""
        tiling = stretched(made.tiling, density / made.density, self._request.options.get("lattice", "square"))
        return tiling and Map.of_tiling(self.surface, self._structure, tiling)

    def turned(self, density: float, progress: Progress | None) -> Map | None:
        """A tiling whose rows may run less level: other numbers of tiles fit around a limb. None where it is none."""
        size = {"tiles": density * self.surface.area, "size_counts": True, "max_turn": MOST_TURNED}
        try:
            return self._of_tiles(size, progress)
        except REFUSALS:
            return None

    def _of_tiles(self, size, progress):
        """One that turns where that is asked for; one that is only shifted where that is impossible, or where the other
        is poor or loses triangles and it costs less: its jumps are symmetries of the texture, too."""
        turns, lines = self._request.options.get("turns", 1), self._request.options.get("lines", AUTOMATIC)
        if turns == 1:
            return self._shifted(size, progress)
        if self._has_cones:
            return self._with(self._request.poles, size, progress, turns=turns)
        step, size = scaled(progress, 1.0, 1.0), size | ({"lattice": LATTICE[turns]} if turns in LATTICE else {})
        if lines == MIRROR or lines in EDGED and len(self._edges_of_lines):
            if lined := self._with_turns(size, progress, turns, lines):
                return lined
            progress = step
        if (regular := self._regular(size, step)) is not None:
            return regular
        turned = self._with_turns(size, progress, turns)
        if turned is None:
            return self._shifted(size, step)
        if lines == AUTOMATIC and turns in LINED_TURNS and (lined := self._lined(turned, size, turns, step)):
            return lined
        if turned.quality.lost_part == 0 and (_but_direction(turned) < POOR_TURNED or not self._budget.goes_on()):
            return turned
        try:
            return min(turned, self._shifted(size, step), key=lambda each: each.cost)
        except REFUSALS:
            return turned

    def _lined(self, turned, size, turns, progress):
        """The tiling whose rows end at hard edges, or run along them, if it costs hardly more than the one that turns
        and loses nothing; None if none does."""
        if len(self.surface.triangles) > MOST_LINED_TRIANGLES:
            return None
        length = self.surface._native.edge_lengths[self._edges_of_lines].sum() / math.sqrt(self.surface.area)
        if length < 1 or not self._budget.goes_on():
            return None
        most = turned.cost + min(LINED * length, MOST_LINED)
        for lines in EDGED:
            made = self._with_turns(size, progress, turns, lines)
            if made and made.quality.lost_part == 0 and made.cost < most:
                return made
        return None

    @cached_property
    def _marked(self):
        """The marked edges that may be lines: all where lines are asked for."""
        marked, lines = (self._request.options.get(name) for name in ("marked", "lines"))
        return marked if marked is not None and (lines in EDGED or are_whole(marked)) else None

    @cached_property
    def _edges_of_lines(self):
        return lines_of(self.surface, self._marked)

    def _with_turns(self, size, progress, turns, lines="none"):
        """None where there is none."""
        try:
            return self._with(self._request.poles, size, progress, turns=turns, lines=lines)
        except REFUSALS:
            return None

    def _regular(self, size, progress):
        """The tiling without poles where the best map is asked for and needs no cones; else None."""
        is_best = self._request.main == "automatic" and self._is_open and self._has_tilings_without_poles
        if not is_best or self.guess_without_poles(progress) > REGULAR:
            return None
        try:
            made = self._with(0, size, progress)
        except REFUSALS:
            return None
        return made if made.quality.lost_part == 0 and _but_direction(made) <= REGULAR else None

    def _shifted(self, size, progress):
        """The one of least cost among those with the poles that are asked for, or, where that is left open, with as
        many as the density asks for, with none, or with two more: on few faces the density is less even than it was
        expected when poles were placed."""
        step = scaled(progress, 1.0, 1.0)
        if not self._is_open:
            return self._with(self._request.poles, size, progress)
        try:
            made = self._with("auto", size, progress)
        except REFUSALS:
            if not self._has_tilings_without_poles:
                raise
            return self._with(0, size, step)
        for count in self._other_counts(made):
            if not self._budget.goes_on():
                break
            try:
                if count or self.guess_without_poles(step) < _but_direction(made):
                    made = min(made, self._with(count, size, step), key=lambda each: each.cost)
            except REFUSALS:
                continue
        return made

    def _other_counts(self, made):
        """Yields the numbers of poles with which a tiling may cost less than this one."""
        if not len(made.poles):
            return
        if self._has_tilings_without_poles:
            yield 0
        is_evened = made.evenness > 0 and made.tiling.tiles >= MANY_TILES
        is_quick = len(self.surface.triangles) <= FEW_TRIANGLES
        if is_evened and is_quick and made.drawn_range > UNEVEN and len(made.poles) < MOST_POLES:
            yield len(made.poles) + MORE_POLES

    @property
    def _has_cones(self):
        """Whether they are chosen."""
        return self._request.options.get("cones") is not None

    @property
    def _has_no_poles(self):
        return isinstance(self._request.poles, numbers.Real) and self._request.poles == 0

    @property
    def _is_open(self):
        """Whether the number of poles is."""
        return isinstance(self._request.poles, str) and self._request.poles == "auto"

    @property
    def _has_tilings_without_poles(self):
        return self.surface.genus > 0 or self.surface.boundary_count > 1

    def _with(self, poles, size, progress, turns=1, lines="none"):
        """Raises what `Structure.tile` raises; TopologyError where too much is lost."""
        options = {**self._request.tiling, "moves": {}, **size, "turns": turns, "lines": lines}
        options["marked"] = None if lines == "none" else self._marked
        options["cones"] = options.get("cones") if turns != 1 and lines == "none" else None
        made = self._structure.tile(poles=poles, surface=self.surface, progress=progress, **options)
        lost = made.quality.lost_part
        if not lost < MOST_LOST:
            raise TopologyError(f"it would lose {percent(lost)} of its area, as the mesh is too coarse: subdivide it")
        return Map.of_tiling(self.surface, self._structure, self._under_texture(made))

    def _under_texture(self, made):
        """The tiling with the direction that is seen of the texture it is made for: that may turn, too."""
        turns, direction = self._request.options.get("turns", 1), made.quality.direction
        if direction is None or turns == direction.turns:
            return made
        return replace(made, quality=replace(made.quality, direction=direction.under(turns)))


def _but_direction(made):
    """The cost of a tiling but for that of its direction, which bounds and guesses know nothing of."""
    return made.cost - of_direction(made.quality)


def stretched(tiling: Tiling, factor: float, lattice: str | ArrayLike) -> Tiling | None:
    """The tiling with this multiple of its density, stretched across its jumps where these all run along one line, as
    around a limb with a pole at each end: no seam shows all the same. None where there are jumps both ways, or it would
    be stretched by more than `MOST_STRETCHED`.

    factor : more than 0; lattice : of the tiling, as in `Structure.tile`
    """
    jumps = np.concatenate([tiling.residues, tiling.periods @ np.array(generators(lattice))])
    if not len(jumps) or not 1 / MOST_STRETCHED <= factor <= MOST_STRETCHED:
        return None
    line = jumps[np.abs(jumps).argmax()]
    if not np.all(np.abs((np.conj(line) * jumps).imag) <= ALONG * abs(line) ** 2):
        return None
    # Both sides of a cut are as far across the line, exactly, and are shifted by the same.
    across = np.array([-line.imag, line.real])
    shift = ((factor - 1) / abs(line) ** 2) * (tiling.uv @ across)[:, None] * across
    uv = arrays.frozen(tiling.uv + on_grid(shift))
    return replace(tiling, uv=uv, tiles=factor * tiling.tiles, quality=_scaled(tiling.quality, uv, factor))


def _scaled(before, uv, factor):
    """The `Quality` where all areas are multiplied. Their quantiles are, too: measured again, rounding might take
    another of two triangles between which the median is."""
    area, median = arrays.frozen(factor * before.area), factor * before.median_density
    same = {"density_ratio": before.density_ratio, "unseen_angle": before.unseen_angle}
    quality = replace(Quality.of(before._triangulation, uv, 1), area=area, median_density=median, **same)
    return quality.upright(uv, before.direction.up, before.direction.turns) if before.direction else quality
