"""A part that may be mapped in pieces: which are worth it, and the map of a wanted density."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Integers, Progress
from ..core.progress import scaled
from ..cutting.hard_edges import bends
from ..cutting.island_map import HARD, SMOOTH
from ..quality.appearance import HARD_SEAM, TURN, cost
from ..tiling.tiling import Poles
from .automatic_structure import automatic_structure
from .map import Map, form_map
from .map_choice import FLAT, GOOD, MOST_SOFT, REFUSALS, Refusal, Undecided, first_map
from .mixed_map import mixed_map
from .pieces import REST, Piece, cut_apart, names_of_pieces, smooth_pieces
from .size import Window, is_in, nearest, relative_size, window_around
from .sizing import Sizing, Tried
from .tubes import closed, is_tube, opened

MIXING = 0.5  # part of the work, for the pieces
EXACT = (1.0, 1.0)  # the window of the wanted density alone


@dataclass(frozen=True)
class Division:
    """names : (#F,) the piece of each polygon; pieces : those that may get a tiling, the largest first"""

    names: Integers
    pieces: tuple[tuple[Piece, Undecided], ...]


@dataclass(frozen=True)
class Divided:
    """A part that may be mapped in pieces, by one of several divisions. other : what the part gets as a whole"""

    other: Map | Undecided
    divisions: tuple[Division, ...]
    evenness: float
    threads: int | None


def divided(
    found: Map | Undecided, evenness: float, threads: int | None, progress: Progress | None
) -> Map | Undecided | Divided:
    """The result of `first_map` for a part, or a `Divided` of it if pieces may make a better map."""
    flat = found.islands if isinstance(found, Map) else found.islands and found.islands.known
    if not _may_be_divided(found, flat):
        return found
    divisions = []
    for names in _names(found.surface):
        pieces = smooth_pieces(found.surface, flat, names, threads or 0)
        pairs = [(piece, _undecided(piece, evenness, threads, progress)) for piece in pieces]
        solved = tuple((piece, undecided) for piece, undecided in pairs if undecided)
        divisions += [Division(names, solved)] if solved else []
    return Divided(found, tuple(divisions), evenness, threads) if divisions else found


def _names(surface):
    """Yields the names of the pieces between hard edges, by each angle that gives others and more than one."""
    bent, known = bends(surface), None
    for degrees in (angle for angle in HARD if angle > SMOOTH):
        names = names_of_pieces(surface, bent > math.radians(degrees))
        if names.max() != names.min() and not np.array_equal(names, known):
            known = names
            yield names


def _may_be_divided(found, flat):
    if found.surface.vertices is None or found.surface.area == 0 or (isinstance(found, Map) and not flat):
        return False
    return flat is None or flat.soft_length > MOST_SOFT or cost(flat.quality) > FLAT


def _undecided(piece, evenness, threads, progress):
    """None for a piece on which nothing can be solved: it becomes an island."""
    try:
        surface = closed(piece.surface)
        structure = automatic_structure(surface, threads=threads, progress=scaled(progress, 1.0, 1.0))
    except REFUSALS:
        return None
    return Undecided(surface, structure, form_map(surface, structure), evenness=evenness)


@dataclass(frozen=True, eq=False)
class _Tiled:
    """A piece with its tiling. is_tube : but for windows"""

    piece: Piece
    map: Map
    is_tube: bool

    @cached_property
    def turn(self):
        """The cost of rows that turn in its islands; 0 where poles turn them in the tiling, too."""
        return TURN * self.piece.turn(self.map.uv) if self.is_tube and not len(self.map.poles) else 0.0


class _Found(NamedTuple):
    """The map in pieces, or None; its cost, and the cost of rows that turn if all its pieces are islands."""

    map: Map | None = None
    minded: float = math.inf
    turns: float = 0.0

    @property
    def is_good(self):
        return self.map is not None and _without_hard_edges(self.map.mixed) <= GOOD

    def or_else(self, other):
        """The map in pieces, or another one of less cost. Without a map in pieces, the other one or its error."""
        if self.map is None or not isinstance(other, Map):
            return self.map or other
        return self.map if self.minded < other.cost + (self.turns if other.islands else 0.0) else other


@dataclass(frozen=True)
class MixedSizing:
    """A `Divided` part, and what is asked of tilings: poles and other options of `Structure.tile`. Its functions are
    those of `Sizing`."""

    part: Divided
    poles: Poles
    options: Mapping[str, Any]
    _rest: dict[bytes, Map] = field(default_factory=dict)

    def about(self, density: float, tries: int, progress: Progress | None) -> Map | Refusal:
        """The map in pieces if that costs less, or else the other one. The density of the largest piece is the one near
        `density` that whole tiles allow.
        """
        found = self._in_pieces(density, tries, window_around(), scaled(progress, 0.0, MIXING))
        other = self.part.other
        if isinstance(other, Map) or found.is_good:
            return found.or_else(other)
        return found.or_else(self._sizing(other).about(density, tries, scaled(progress, MIXING, 1.0)))

    def tried(self, density: float, tries: int, progress: Progress | None) -> Tried:
        """Tries the map in pieces, as a tiling, if that costs less, or else whole tilings."""
        found = self._in_pieces(density, 0, window_around(), scaled(progress, 0.0, MIXING))
        other, is_map = self.part.other, isinstance(self.part.other, Map)
        if found.is_good and not is_map:
            return Tried([found.map], None)
        tried = Tried([], other) if is_map else self._sizing(other).tried(density, tries, scaled(progress, MIXING, 1.0))
        rival = nearest(tried.tilings, density) if tried.tilings else tried.other
        return tried if found.or_else(rival) is rival else Tried([found.map], None)

    def settled(self, tried: Tried, density: float, window: Window, progress: Progress | None) -> Map | Refusal:
        """Returns the map in pieces with exactly the density, if the one that was tried is not in the window; or else
        the other map.
        """
        if tried.tilings and tried.tilings[0].mixed:
            (made,) = tried.tilings
            is_inside = is_in(window, relative_size(made, density))
            return made if is_inside else self._in_pieces(density, 0, EXACT, progress).map or made
        other = self.part.other
        return other if isinstance(other, Map) else self._sizing(other).settled(tried, density, window, progress)

    def _in_pieces(self, density, tries, window, progress):
        """The `_Found` of least cost among the divisions.

        window : of pieces' densities over the one that is wanted
        """
        best, count = _Found(), len(self.part.divisions)
        for n, division in enumerate(self.part.divisions):
            tiled = self._tiled(division, density, tries, window, scaled(progress, n / count, (n + 1) / count))
            mixed, minded = self._least_minded(division, tiled, scaled(progress, (n + 1) / count, (n + 1) / count))
            best = min(best, _Found(mixed, minded, self._turns(tiled)), key=lambda found: found.minded)
            if mixed and _without_hard_edges(mixed.mixed) <= FLAT:
                break
        return best

    def _tiled(self, division, density, tries, window, progress):
        """The `_Tiled` pieces that may be better than islands. tries : numbers of tiles for the first one, the largest,
        whose density is then that of the others; 0 where the density is given"""
        made, count = [], len(division.pieces)
        for n, (piece, undecided) in enumerate(division.pieces):
            sizing, step = self._sizing(undecided), scaled(progress, n / count, (n + 1) / count)
            if sizing.is_strict:
                return []
            is_first = tries > 0 and not made
            tiling = sizing.about(density, tries, step) if is_first else sizing.of_piece(density, window, step)
            if not isinstance(tiling, Map) or not tiling.tiling:
                continue
            one = _Tiled(piece, opened(tiling, piece.surface), is_tube(undecided.surface))
            if one.map.cost < piece.cost + one.turn:
                density = one.map.density if is_first else density
                made.append(one)
        return made

    def _least_minded(self, division, tiled, progress):
        """(The map in pieces, or None; its cost with that of rows that turn in its islands)"""
        choices = [tiled, [one for one in tiled if one.map.cost < one.piece.cost]]
        best, least = None, math.inf
        for kept in choices[: 1 + (len(choices[1]) < len(tiled))]:
            found = self._glued(division, kept, progress) if kept else None
            minded = found.cost + self._turns(one for one in tiled if one not in kept) if found else math.inf
            if minded < least:
                best, least = found, minded
        return best, least

    def _glued(self, division, tiled, progress):
        """The map with these tilings; None where the rest has none."""
        names = np.where(np.isin(division.names, [one.piece.name for one in tiled]), division.names, REST)
        other, evenness = self.part.other, self.part.evenness
        try:
            parts = [one for one in cut_apart(other.surface, names) if names[one.face_index[0]] == REST]
            rest = [self._untiled(one, progress) for one in parts]
        except REFUSALS:
            return None
        return mixed_map(other.surface, other.structure, [one.map for one in tiled] + rest, evenness)

    def _untiled(self, piece, progress):
        """The map of a piece without tiling. Several divisions have the same pieces."""
        key = piece.face_index.tobytes()
        if key not in self._rest:
            self._rest[key] = first_map(piece, None, "untiled", self.part.evenness, self.part.threads, progress)
        return self._rest[key]

    def _turns(self, tiled):
        """The cost of rows that turn, for the whole part, if these pieces are islands."""
        return sum(one.turn * one.piece.surface.area for one in tiled) / self.part.other.surface.area

    def _sizing(self, undecided):
        return Sizing(undecided, self.poles, self.options)


def _without_hard_edges(mixed):
    """The cost of a map without its hard edges, where a tiling of the whole part would stretch."""
    return mixed.cost - HARD_SEAM * mixed.hard_length
