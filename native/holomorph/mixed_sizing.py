"""A part that may be mapped in pieces: which are worth it, and the map of a wanted density."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .appearance import HARD_SEAM, TURN, cost
from .array_types import Integers, Progress
from .automatic_structure import automatic_structure
from .hard_edges import bends
from .island_map import HARD, SMOOTH
from .map import Map, form_map
from .map_choice import FLAT, GOOD, MOST_SOFT, REFUSALS, Refusal, Undecided, first_map
from .mixed_map import mixed_map
from .pieces import Piece, cut_apart, names_of_pieces, smooth_pieces
from .progress import scaled
from .sizing import Sizing
from .tiling import Poles
from .tube import is_tube

REST = -1  # name of the polygons of all pieces without a tiling
MIXING = 0.5  # of the work, for the pieces


@dataclass(frozen=True)
class Divided:
    """A part that may be mapped in pieces. names : (#F,) the piece of each polygon; pieces : those that may get a
    tiling, the largest first; other : what the part gets else"""

    other: Map | Undecided
    names: Integers
    pieces: tuple[tuple[Piece, Undecided], ...]
    evenness: float
    threads: int | None


def divided(
    found: Map | Undecided, evenness: float, threads: int | None, progress: Progress | None
) -> Map | Undecided | Divided:
    """What `first_map` gives for a part, or that with pieces of the part, where these may make a better map."""
    flat = found.islands if isinstance(found, Map) else found.flat
    if not _may_be_divided(found, flat):
        return found
    bent, surface = bends(found.surface), found.surface
    for degrees in (angle for angle in HARD if angle > SMOOTH):
        names = names_of_pieces(surface, bent > math.radians(degrees))
        pieces = smooth_pieces(surface, flat, names, threads or 0) if names.any() else []
        if pieces:
            undecided = [_undecided(piece.surface, evenness, threads, progress) for piece in pieces]
            return Divided(found, names, tuple(zip(pieces, undecided)), evenness, threads)
    return found


def _may_be_divided(found, flat):
    if found.surface.vertices is None or found.surface.area == 0 or (isinstance(found, Map) and not flat):
        return False
    return flat is None or flat.soft_length > MOST_SOFT or cost(flat.quality) > FLAT


def _undecided(piece, evenness, threads, progress):
    structure = automatic_structure(piece, threads=threads, progress=scaled(progress, 1.0, 1.0))
    return Undecided(piece, structure, form_map(piece, structure), evenness=evenness)


@dataclass(frozen=True, eq=False)
class _Tiled:
    """A piece with its tiling. share : its part of the area"""

    piece: Piece
    map: Map
    share: float

    @cached_property
    def turn(self):
        """What is minded of how far rows turn in its islands; nothing where poles turn them in the tiling, too."""
        is_round = is_tube(self.piece.surface) and not len(self.map.poles)
        return TURN * self.piece.turn(self.map.uv) if is_round else 0.0

    @property
    def turns(self):
        """Of the whole part."""
        return self.share * self.turn


@dataclass(frozen=True)
class MixedSizing:
    """A `Divided` part, and what is asked of tilings: poles and other options of `Structure.tile`."""

    part: Divided
    poles: Poles
    options: Mapping[str, Any]

    def at(self, density: float, progress: Progress | None) -> Map | Refusal:
        """As `Sizing.at`."""
        return self.about(density, 0, progress)

    def about(self, density: float, tries: int, progress: Progress | None) -> Map | Refusal:
        """As `Sizing.about`; in pieces where that is less minded."""
        tiled, other = self._tiled(density, tries, scaled(progress, 0.0, MIXING)), self.part.other
        mixed, turns = self._least_minded(tiled, scaled(progress, MIXING, MIXING))
        if isinstance(other, Undecided):
            if mixed and _is_taken_at_once(mixed.mixed):
                return mixed
            other = self._sizing(other).about(density, tries, scaled(progress, MIXING, 1.0))
        if mixed is None or not isinstance(other, Map):
            return mixed or other
        all_turns = sum(one.turns for one in tiled) if other.islands else 0.0
        return mixed if mixed.cost + turns < other.cost + all_turns else other

    def _tiled(self, density, tries, progress):
        """The `_Tiled` pieces that may be better than islands: of one density, that of the largest."""
        pieces, made = self.part.pieces, []
        for n, (piece, undecided) in enumerate(pieces):
            step = scaled(progress, n / len(pieces), (n + 1) / len(pieces))
            sizing = self._sizing(undecided)
            tiling = None if sizing.is_strict else sizing.tiling(density, 0 if made else tries, step)
            one = tiling and _Tiled(piece, tiling, piece.surface.area / self.part.other.surface.area)
            if one and tiling.cost < piece.cost + one.turn:
                density = density if made else tiling.density
                made.append(one)
        return made

    def _least_minded(self, tiled, progress):
        """(The map in pieces, what is minded of how far rows turn in its islands); None where there is none."""
        choices = [tiled, [one for one in tiled if one.map.cost < one.piece.cost]]
        best, least = None, math.inf
        for kept in choices[: 1 + (len(choices[1]) < len(tiled))]:
            found = self._glued(kept, progress) if kept else None
            turns = sum(one.turns for one in tiled if one not in kept)
            if found and found.cost + turns < least:
                best, least = found, found.cost + turns
        return best, least - best.cost if best else 0.0

    def _glued(self, tiled, progress):
        """The map with these tilings; None where the rest has none."""
        names = np.where(np.isin(self.part.names, [one.piece.name for one in tiled]), self.part.names, REST)
        other, evenness = self.part.other, self.part.evenness
        try:
            parts = [one for one in cut_apart(other.surface, names) if names[one.face_index[0]] == REST]
            rest = [first_map(one, None, "untiled", evenness, self.part.threads, progress) for one in parts]
        except REFUSALS:
            return None
        return mixed_map(other.surface, other.structure, [one.map for one in tiled] + rest, evenness)

    def _sizing(self, undecided):
        return Sizing(undecided, self.poles, self.options)


def _is_taken_at_once(mixed):
    """Hard edges do not count: a tiling of the whole part would stretch there."""
    return mixed.cost - HARD_SEAM * mixed.hard_length <= GOOD
