"""A tiling of a wanted density: the number of tiles that gives it, or another map where no number does."""

import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..core.array_types import Progress
from ..core.progress import scaled
from ..tiling.tiling import Poles
from .map import Map
from .map_choice import REFUSALS, Refusal, Undecided
from .size import TRIES, Window, is_in, nearest, relative_size, window_around
from .tubes import is_tube

MOST_TURNED = 0.5  # radians from the direction that is asked for, where no whole tiles of one size are nearer to it
TOO_FEW = "too few whole tiles fit on it for squares of the wanted size"


class Tried(NamedTuple):
    """tilings : with several numbers of tiles; other : the first map that is none, or how one is refused"""

    tilings: Sequence[Map]
    other: Map | Refusal | None


@dataclass(frozen=True)
class Sizing:
    """A part that may get a tiling, and what is asked of that: poles and other options of `Structure.tile`."""

    undecided: Undecided
    poles: Poles
    options: Mapping[str, Any]

    def about(self, density: float, tries: int, progress: Progress | None) -> Map | Refusal:
        """The map with the nearest density that this many numbers of tiles give, or how it is refused."""
        tilings, other = self.tried(density, tries, progress)
        return self._moved(nearest(tilings, density), tries, progress) if tilings else other

    def tried(self, density: float, tries: int, progress: Progress | None) -> Tried:
        """Tries one number of tiles after the other, until the density is the wanted one."""
        tilings, tiles, below, above = [], density * self.undecided.surface.area, 0.0, math.inf
        options = {**self.options, "moves": {}, "size_counts": tries > 1}
        for attempt in range(tries):
            step = scaled(progress, attempt / tries, (attempt + 1) / tries)
            try:
                made = self.undecided.tiled(self.poles, {**options, "tiles": tiles or None}, step)
            except REFUSALS as error:
                return Tried(tilings, error)
            if made.tiling is None:
                return Tried(tilings, made)
            tilings.append(made)
            size = relative_size(made, density)
            if is_in(window_around(), size):
                break
            below, above = (max(below, tiles), above) if size < 1 else (below, min(above, tiles))
            tiles /= size
            if not below < tiles < above:  # the density grows in steps
                tiles = math.sqrt(below * above)
        return Tried(tilings, None)

    def settled(self, tried: Tried, density: float, window: Window, progress: Progress | None) -> Map | Refusal:
        """The tiling that was tried and is in the window, or stretched to the density, or turned until it is in the
        window; else the best other map. What is asked for explicitly, such as poles that are chosen or moved, is
        made with another density, or refused."""
        tilings, other = tried
        if not tilings:
            is_final = isinstance(other, Map) or self.is_strict
            return other if is_final else self.undecided.untiled(str(other), progress)
        inside = [made for made in tilings if is_in(window, relative_size(made, density))]
        made = self._moved(nearest(inside or tilings, density), TRIES, progress)
        is_done = inside or not isinstance(made, Map) or made.tiling is None
        return made if is_done else self._fitted(made, density, window, progress)

    def _fitted(self, made, density, window, progress):
        stretched = self.undecided.stretched(made, density, self.options.get("lattice", "square"), progress)
        if stretched or self.is_strict:
            return stretched or made
        turned = self._turned(density, progress)
        if turned and is_in(window, relative_size(turned, density)):
            return turned
        return self.undecided.untiled(TOO_FEW, progress, made.tiling)

    def of_piece(self, density: float, window: Window, progress: Progress | None) -> Map | None:
        """The tiling of a piece of a part whose density over this one is in the window, or for which it is stretched;
        None where there is none."""
        surface = self.undecided.surface
        tilings, _ = self.tried(density, 1 if is_tube(surface) else TRIES, progress)
        made = nearest(tilings, density) if tilings else None
        if made is None or is_in(window, relative_size(made, density)):
            return made
        stretched = self.undecided.stretched(made, density, self.options.get("lattice", "square"), progress)
        return stretched or (made if is_in(window_around(), relative_size(made, density)) else None)

    def _turned(self, density, progress):
        """A tiling whose rows may run less level: other numbers of tiles fit around a limb. None where it is none."""
        options = {**self.options, "tiles": density * self.undecided.surface.area, "size_counts": True}
        try:
            made = self.undecided.tiled(self.poles, {**options, "max_turn": MOST_TURNED}, progress)
        except REFUSALS:
            return None
        return made if made.tiling else None

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
