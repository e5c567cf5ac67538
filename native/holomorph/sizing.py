"""A tiling of a wanted density: the number of tiles that gives it, or another map where no number does."""

import numbers
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .array_types import Progress
from .map import Map
from .map_choice import REFUSALS, Refusal, Undecided
from .progress import scaled
from .tiling import Poles
from .tube import is_tube, stretched

SAME_SIZE = 0.045  # relative difference of a median density from the wanted one, until which other numbers are tried
LIKE_SIZE = 0.1  # and up to which a tiling stays one: without whole tiles a seam would show
TRIES = 3  # numbers of tiles, until the median density is the wanted one
TOO_FEW = "whole tiles are too few on it for squares of the size of the other parts"


@dataclass(frozen=True)
class Sizing:
    """A part that may get a tiling, and what is asked of that: poles and other options of `Structure.tile`."""

    undecided: Undecided
    poles: Poles
    options: Mapping[str, Any]

    def about(self, density: float, tries: int, progress: Progress | None) -> Map | Refusal:
        """The map with this density, or the nearest one that so many numbers of tiles give, or how it is refused.
        Without any try, what is `at` this density."""
        if tries == 0:
            return self.at(density, progress)
        tilings, other = self._tried(density, tries, progress)
        return self._moved(_nearest(tilings, density), tries, progress) if tilings else other

    def at(self, density: float, progress: Progress | None) -> Map | Refusal:
        """The map whose median density is within `LIKE_SIZE` of this one where it is a tiling. What is asked for in so
        many words, such as poles that are chosen or moved, is made with another density, or refused."""
        tilings, other = self._tried(density, TRIES, progress)
        if tilings:
            made = _nearest(tilings, density)
            fits = abs(_excess(made, density)) <= LIKE_SIZE or self.is_strict
            return self._moved(made, TRIES, progress) if fits else self.undecided.untiled(TOO_FEW, made.tiling)
        return other if isinstance(other, Map) or self.is_strict else self.undecided.untiled(str(other))

    def tiling(self, density: float, tries: int, progress: Progress | None) -> Map | None:
        """The nearest tiling that so many numbers of tiles give; without any try one that is within `LIKE_SIZE` of the
        density, for which a tube is stretched. None where there is none."""
        surface = self.undecided.surface
        tilings, _ = self._tried(density, tries or (1 if is_tube(surface) else TRIES), progress)
        made = _nearest(tilings, density) if tilings else None
        if made is None or tries or abs(_excess(made, density)) <= SAME_SIZE:
            return made
        long = stretched(made, density) if is_tube(surface) else None
        return long or (made if abs(_excess(made, density)) <= LIKE_SIZE else None)

    def _tried(self, density, tries, progress):
        """(tilings, the first that is none or how it is refused): with one number of tiles after the other, until the
        density is the wanted one."""
        tilings, tiles = [], density * self.undecided.surface.area
        options = {**self.options, "moves": {}, "size_counts": tries > 1}
        for attempt in range(tries):
            step = scaled(progress, attempt / tries, (attempt + 1) / tries)
            try:
                made = self.undecided.tiled(self.poles, {**options, "tiles": tiles or None}, step)
            except REFUSALS as error:
                return tilings, error
            if made.tiling is None:
                return tilings, made
            tilings.append(made)
            if abs(_excess(made, density)) <= SAME_SIZE:
                break
            tiles /= 1 + _excess(made, density)
        return tilings, None

    def _moved(self, made, tries, progress):
        """The map with poles moved after its rounding, or how that is refused."""
        if not self.options.get("moves"):
            return made
        options = {**self.options, "tiles": made.tiling.tiles, "size_counts": tries > 1}
        try:
            return self.undecided.tiled(self.poles, options, scaled(progress, 1.0, 1.0))
        except REFUSALS as error:
            return error

    @property
    def is_strict(self) -> bool:
        """Whether more is asked of a tiling than its density."""
        is_chosen = not isinstance(self.poles, (str, numbers.Real)) or self.poles not in ("auto", 0)
        is_bound = any(self.options.get(name) is not None for name in ("max_added", "allowed"))
        return is_chosen or is_bound or bool(self.options.get("moves"))


def _nearest(tilings, density):
    return min(tilings, key=lambda made: abs(_excess(made, density)))


def _excess(made, density):
    return made.quality.median_density / density - 1 if density > 0 else 0.0
