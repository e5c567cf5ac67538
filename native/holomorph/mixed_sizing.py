"""A part that may be mapped in pieces: which are worth it, and the map of a wanted density."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .appearance import HARD_SEAM, cost
from .array_types import Integers, Progress
from .automatic_structure import automatic_structure
from .hard_edges import bends
from .island_map import HARD, SMOOTH
from .map import Map, form_map
from .map_choice import FLAT, GOOD, MOST_SOFT, REFUSALS, Refusal, Undecided, first_map
from .mixed_map import mixed_map
from .pieces import Piece, cut_apart, names_of_pieces, smooth_pieces
from .progress import scaled
from .sizing import TRIES, Sizing
from .tiling import Poles

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
            pieces.sort(key=lambda piece: -piece.surface.area)
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


@dataclass(frozen=True)
class MixedSizing:
    """A `Divided` part, and what is asked of tilings: poles and other options of `Structure.tile`."""

    part: Divided
    poles: Poles
    options: Mapping[str, Any]

    def about(self, density: float, tries: int, progress: Progress | None) -> Map | Refusal:
        """As `Sizing.about`."""
        mixed = self._mixed(density, tries, scaled(progress, 0.0, MIXING))
        return self._less_minded(mixed, "about", (density, tries), progress)

    def at(self, density: float, progress: Progress | None) -> Map | Refusal:
        """As `Sizing.at`."""
        mixed = self._mixed(density, 0, scaled(progress, 0.0, MIXING))
        return self._less_minded(mixed, "at", (density,), progress)

    def _less_minded(self, mixed, how, size, progress):
        other = self.part.other
        if isinstance(other, Undecided):
            if mixed and mixed.cost - HARD_SEAM * mixed.mixed.hard_length <= GOOD:
                return mixed
            other = getattr(Sizing(other, self.poles, self.options), how)(*size, scaled(progress, MIXING, 1.0))
        return mixed if mixed and (not isinstance(other, Map) or mixed.cost < other.cost) else other

    def _mixed(self, density, tries, progress):
        """The map in pieces; None where none of them gets a tiling, or the rest has no map."""
        made, names = [], np.full_like(self.part.names, REST)
        for n, (piece, undecided) in enumerate(self.part.pieces):
            step = scaled(progress, n / (len(self.part.pieces) + 1), (n + 1) / (len(self.part.pieces) + 1))
            tiling = Sizing(undecided, self.poles, self.options).tiling(density, 0 if made else tries, step)
            if tiling is None or tiling.cost >= piece.cost:
                continue
            density = tiling.density if not made else density
            made.append(tiling)
            names[self.part.names == piece.name] = piece.name
        if not made:
            return None
        surface = self.part.other.surface
        try:
            rest = [self._untiled(one) for one in cut_apart(surface, names) if names[one.face_index[0]] == REST]
        except REFUSALS:
            return None
        return mixed_map(surface, self.part.other.structure, made + rest, self.part.evenness)

    def _untiled(self, surface):
        return first_map(surface, None, "untiled", self.part.evenness, self.part.threads, None)
