"""Which map a part gets: flat islands, the balanced one of its structure, or a seamless tiling."""

import math
from dataclasses import dataclass

import numpy as np

from .._native import InvalidMesh, SolverError, TopologyError
from ..core.progress import scaled
from ..core.value import counted, quoted
from ..cutting.island_map import HARD, IslandSearch, one_island
from ..mesh.checks import checked_evenness
from ..mesh.surface import Surface
from ..quality.appearance import cost
from .automatic_structure import AnyStructure, automatic_structure
from .map import Map, form_map
from .stretched import stretched

REFUSALS = InvalidMesh, TopologyError, SolverError  # what is said about one part, others go on
Refusal = InvalidMesh | TopologyError | SolverError

MAIN_MAPS = ("automatic", "seamless", "untiled", "balanced")

EVEN = 1.41  # size range below which a map without seams stays: the squares' sizes hardly differ
LESS_EVEN = 1.005  # the size range of a tiling over that of the balanced map, with which it still takes its place
MORE_SHEARED = 1.1  # the capped mean s1 / s2 of a tiling over that of the balanced map: a few triangles do not decide
EVENING_SHEARS = 0.5  # what evenness 1 adds to the mean s1 / s2 of a tiling, for which it was asked
MOST_FLIPPED = 0.02  # part of the area: what flips lies beside branch points, and few are seen
MOST_LOST = 0.02  # and with what collapses, of a tiling that was asked for

# The poles of the tilings that are tried; the first one that is better is taken. Without any, the map of a ring, such
# as a pipe, is the balanced one, scaled until whole tiles fit around it.
POLES = ("auto", 0)

# The evened density ratio above which two more poles are tried, where that is quick, and tiles are so many that their
# rounding decides less than the poles.
UNEVEN, MORE_POLES, MOST_POLES, FEW_TRIANGLES, MANY_TILES = 1.73, 2, 16, 5000, 60

# What islands may cost (see `appearance`) to be taken at once: less than a tiling does with poles, or where none may be
# needed, as around a ring, so little that squares hardly differ.
GOOD, FLAT = 0.8, 0.3
MOST_SOFT = 0.02  # length of a seam across the smooth over the square root of the area, that is not minded

# The work on a tiling, in millionths of about a second, for each triangle of the level on which poles are placed, and
# of the part; how much of it is spent on islands where there is a tiling, and what is spent on them in any case.
PLACED, LEVEL, ROUNDED = 40, 10_000, 8
BUDGET, LEAST_WORK = 0.4, 100_000

EVENNESS = 0.5  # what suits textures: squares hardly differ in size, and their shear is not seen

SOLVING = 0.5  # part of the work, for the structure


def first_map(surface, structure, main, evenness, threads, progress, coefficients=None):
    """The `Map` of flat islands, or the balanced one, where it stays; `Undecided` where a tiling may take its place."""
    if main not in MAIN_MAPS:
        raise ValueError(f"main is {quoted(main)}; one of {', '.join(MAIN_MAPS)} is needed")
    evenness = checked_evenness(evenness)
    if structure is None:
        structure = automatic_structure(surface, threads=threads, progress=progress)
    if main == "seamless":
        return Undecided(surface, structure, None, evenness=evenness)
    if main == "balanced":
        return form_map(surface, structure, coefficients, evenness=evenness, progress=progress)
    islands, step = FlatIslands(surface, evenness, threads), scaled(progress, 1.0, 1.0)
    if main == "untiled":
        return islands.or_else(form_map(surface, structure, why="it has no tiling", evenness=evenness), step)
    flat = islands.at_once(step)
    if flat and _is_taken_at_once(flat, surface):
        return _map_of(flat, surface, structure)
    balanced = form_map(surface, structure)
    why = _why_it_stays(balanced)
    if why:
        return form_map(surface, structure, why=why, evenness=evenness)
    return Undecided(surface, structure, balanced, islands, evenness)


class FlatIslands:
    """The flat islands of a part, none where there are none, or they collapse, as where all faces lie on lines. They
    are looked for when they are asked for: on a smooth part they take longer than a tiling, and cost more."""

    def __init__(self, surface, evenness, threads):
        is_flat = surface.vertices is None or surface.area == 0
        self._search = None if is_flat else IslandSearch(surface, HARD, evenness, threads or 0)

    @property
    def known(self):
        """The best `Islands` so far, None where they were not yet looked for."""
        return self._search and self._search.known

    def at_once(self, progress):
        """The `Islands` that may be taken at once, if there are any, or better ones."""
        flat = self._asked(lambda search: search.at_once(GOOD, progress))
        if flat is None or cost(flat.quality) <= FLAT:
            return flat
        return self._asked(lambda search: search.best(flat.cost, _work(search.surface), progress)) or flat

    def or_else(self, found, progress, work=math.inf):
        """The `Map` of islands, if they look better than another `Map` and are found by so much work; else that one."""
        flat = self._asked(lambda search: search.best(found.cost, work, progress))
        return _map_of(flat, found.surface, found.structure) if flat else found

    def _asked(self, ask):
        try:
            found = self._search and ask(self._search)
        except REFUSALS:
            return None  # another map may be made
        return found if found and math.isfinite(found.cost) else None


def _is_taken_at_once(flat, surface):
    is_ring = (surface.genus, surface.boundary_count) in ((0, 2), (1, 0))
    squares_are_even = cost(flat.quality) <= FLAT and flat.soft_length <= MOST_SOFT
    return squares_are_even or (flat.cost <= GOOD and not is_ring)


def _map_of(flat, surface, structure):
    where = "hard edges" if flat.soft_length <= MOST_SOFT else "seams"
    what = "in one piece" if not len(flat.seams) else f"along its {where} into {counted(flat.count, 'piece')}"
    why = f"it flattens {what}: {_size_range(flat.quality)}"
    return Map(surface, structure, flat.uv, flat.quality, np.empty(0), why, islands=flat)


def _why_it_stays(balanced):
    """Why the balanced map stays; "" where a texture would break off at a seam, or vary in size."""
    if balanced.surface.area == 0:
        return "the surface has no area"
    if len(balanced.structure.seams) or not balanced.quality.size_range <= EVEN:
        return ""
    return f"it has no seams, and its squares hardly differ in size: {_size_range(balanced.quality)}"


@dataclass(frozen=True)
class Undecided:
    """A part that may get a tiling. Its other maps are `balanced`, not evened, and `islands`; None where a tiling is
    asked for."""

    surface: Surface
    structure: AnyStructure
    balanced: Map | None
    islands: FlatIslands | None = None
    evenness: float = 0.0

    def tiled(self, poles, options, progress):
        """The `Map`, by `options` of `Structure.tile`. On few faces a density is less even than it was expected when
        poles were placed: then more are tried."""
        made = self._or_islands(self._tiled_or_balanced(poles, options, progress), progress)
        if not (made.tiling and _is_automatic(poles) and self._has_few_poles(made)):
            return made
        try:
            more = self._tiled_or_balanced(len(made.poles) + MORE_POLES, options, scaled(progress, 1.0, 1.0))
        except REFUSALS:
            return made
        return more if more.tiling and more.drawn_range < made.drawn_range else made

    def _has_few_poles(self, made):
        is_evened = made.evenness > 0 and made.tiling.tiles >= MANY_TILES
        is_quick = len(self.surface.triangles) <= FEW_TRIANGLES
        return is_evened and is_quick and made.drawn_range > UNEVEN and 0 < len(made.poles) < MOST_POLES

    def _tiled_or_balanced(self, poles, options, progress):
        if self.balanced is None:
            return self._map(_whole(self._tiling(poles, options, progress)), "it was asked for")
        tried = POLES if _is_automatic(poles) else (poles,)
        reasons = []
        for k, own in enumerate(tried):
            try:
                made = self._tiling(own, options, scaled(progress, k / len(tried), (k + 1) / len(tried)))
            except REFUSALS as error:
                reasons.append(f"no tiling can be made: {error}")
                continue
            drawback = _drawback(made, self.balanced.quality)
            if not drawback:
                return self._map(made, f"it has no visible seams and is no less even: {_size_range(made.quality)}")
            reasons.append(f"a tiling {drawback}")
        return form_map(self.surface, self.structure, why=reasons[0], evenness=self.evenness)

    def untiled(self, why, progress, tiling=None):
        """The best `Map` that is not a tiling. A tiling of another size may be scaled to the wanted one, as one island
        with the seams of that tiling."""
        step = scaled(progress, 1.0, 1.0)
        islands = self.islands or FlatIslands(self.surface, self.evenness, None)
        found = islands.or_else(form_map(self.surface, self.structure, why=why, evenness=self.evenness), step)
        if tiling is None or self.surface.vertices is None:
            return found
        one = one_island(self.surface, tiling)
        made = Map(self.surface, self.structure, one.uv, one.quality, np.empty(0), why, islands=one)
        return made if one.cost < found.cost else found

    def stretched(self, made, density, lattice, progress):
        """The `Map` of the tiling of another one, stretched to a density; None where it cannot be, or another map looks
        better."""
        tiling = stretched(made.tiling, density / made.density, lattice)
        if tiling is None or self.balanced and _drawback(tiling, self.balanced.quality):
            return None
        found = self._map(tiling, made.why)
        return found if self._or_islands(found, progress) is found else None

    def _or_islands(self, found, progress):
        step = scaled(progress, 1.0, 1.0)
        return self.islands.or_else(found, step, _work(self.surface)) if self.islands else found

    def _tiling(self, poles, options, progress):
        return self.structure.tile(poles=poles, surface=self.surface, progress=progress, **options)

    def _map(self, made, why):
        return Map(self.surface, self.structure, made.uv, made.quality, np.empty(0), why, made)


def _work(surface):
    """What may be spent on islands where there is another map, in the unit of `IslandSearch`."""
    count = len(surface.triangles)
    return LEAST_WORK + BUDGET * (PLACED * min(count, LEVEL) + ROUNDED * count)


def _is_automatic(poles):
    return isinstance(poles, str) and poles == "auto"


def _whole(tiling):
    lost = tiling.quality.lost_part
    if lost < MOST_LOST:
        return tiling
    raise TopologyError(f"a tiling would lose {100 * lost:.2g} % of its area, as the mesh is too coarse: subdivide it")


def _drawback(tiling, balanced):
    """Why a tiling does not take the place of a map with the quality `balanced`, "" where it does. It has no visible
    seam: it is to be about as even, and hardly more sheared."""
    quality = tiling.quality
    if not quality.flipped_part < MOST_FLIPPED:
        return f"would flip {100 * quality.flipped_part:.2g} % of the area"
    most_sheared = MORE_SHEARED * balanced.mean_angle + EVENING_SHEARS * tiling.evenness
    if not quality.mean_angle < most_sheared:
        sheared = f"{quality.mean_angle:.3g} instead of {balanced.mean_angle:.3g}"
        return f"would be more sheared: angle distortion {sheared}"
    most = math.inf if math.isnan(balanced.size_range) else balanced.size_range
    if not tiling.size_range < LESS_EVEN * most:
        return f"would be less even: {_size_range(quality)} instead of {most:.3g}"
    return ""


def _size_range(quality):
    return f"size range {quality.size_range:.3g}"
