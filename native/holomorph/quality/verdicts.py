"""Verdicts on UV maps, in words: one judgement for the package, its command and Blender."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.value import counted, percent, rounded
from .appearance import FLIPPED, HARD_SEAM, SEAM, cost, of_overlaps
from .appearance import SHEAR as SHEAR_COST

if TYPE_CHECKING:
    from .quality import Quality

LEVELS = ("good", "fair", "poor", "unusable")
COSTS = (1.2, 2.0, 5.0)  # the largest `appearance.cost` of all levels but the last, by pictures of 46 models

# Where each word but the last ends. They are by area, as all quantities of a verdict.
UNEVEN = (1.45, 1.87, 2.24)  # size range: the root of 2.1, 3.5 and 5 in density
SHEARED = (1.15, 1.4, 2.5)  # angle distortion
EVENNESS = ("even", "fairly even", "uneven", "very uneven")
SHEAR = (None, "slightly sheared", "sheared", "badly sheared")

UNSEEN = 0.3  # angle distortion that evening may add unseen at evenness 1: it is spread out, and squares have one size
LOST = 0.002  # part of the area that is flipped, has collapsed or has no map: less is not told
IN_VIEW, FOLDED = 0.05, 0.1  # lengths of seams and of folds over the root of the area: less is not told
SHORT, LONG = 0.25, 3.0  # likewise, of seams that are called short and long: as a number nobody sees it on thin things
TILED = 0.1  # part of the area that has tilings: poles, turns and cones of less are not told
OVERLAPPING = 1e-6, 0.01, 0.2  # part of the map that islands cover twice: less is rounding, and the limits of levels
USED = 0.4  # part of the image that islands cover: less wastes texels
TURNED = {2: "half turns", 4: "quarter turns", 6: "sixth turns"}  # of tilings, by `Tiling.turns`
# By `Tiling.lines`.
LINED = {"free": "rows run along edges", "whole": "rows end at edges", "mirror": "both halves are alike"}
NEARLY_ALL = 0.9  # part of the area of what turns
PURPOSES = {"verdict": "To tile", "bake": "To bake"}  # of the `Verdict`s in a report


@dataclass(frozen=True)
class Verdict:
    """level: one of `LEVELS`; sentence: what is seen, or what a bake meets."""

    level: str
    sentence: str

    @property
    def is_fit(self) -> bool:
        """Whether the level is good or fair."""
        return self.rank <= LEVELS.index("fair")

    @property
    def rank(self) -> int:
        """The place of the level in `LEVELS`."""
        return LEVELS.index(self.level)


@dataclass(frozen=True)
class Seen:
    """What is seen of a map, or of those of all parts of an object, besides its squares.

    cost : of what follows, as in `appearance.cost`; over several parts the mean by area
    seams, hidden : lengths over the root of the area of those in view, and of those that hard edges hide; None where
        that is not known
    poles, cones : how many tilings have, poles None without tilings; turns, lines : as in `Tiling`; not of tilings of
        less than a tenth of the area
    folded : length of the edges at which the mesh is folded over itself, likewise
    unmapped : part of the area that has no map
    """

    cost: float = 0.0
    seams: float | None = None
    hidden: float = 0.0
    poles: int | None = None
    turns: int = 1
    cones: int = 0
    lines: str = "none"
    folded: float = 0.0
    unmapped: float = 0.0

    def cut(self, seams: float, hidden: float) -> Seen:
        """With more seams, in view and hidden, of these lengths over the root of the area."""
        if not seams and not hidden:
            return self
        cost = self.cost + SEAM * seams + HARD_SEAM * hidden
        return replace(self, cost=cost, seams=(self.seams or 0.0) + seams, hidden=self.hidden + hidden)

    @classmethod
    def joined(cls, parts: Sequence[Seen], areas: ArrayLike, unmapped: float) -> Seen:
        """That of parts with these areas, (n,). Raises ValueError for other shapes and negative areas."""
        weights = arrays.numbers(areas, "areas")
        if weights.shape != (len(parts),) or not (weights >= 0).all():
            raise ValueError(f"areas has the shape {weights.shape}; ({len(parts)},) numbers from 0 on are needed")
        weights = weights / weights.sum() if weights.any() else np.full(len(parts), 1 / len(parts))
        lists = {field.name: [getattr(part, field.name) for part in parts] for field in fields(cls)}
        poles, seams = ([value for value in lists[name] if value is not None] for name in ("poles", "seams"))
        is_tiled = weights @ [value is not None for value in lists["poles"]] >= TILED
        means = {name: float(weights @ lists[name]) for name in ("cost", "hidden", "folded")}
        means["seams"] = float(weights @ [value or 0.0 for value in lists["seams"]]) if seams else None
        tiled = {"poles": sum(poles), "turns": max(lists["turns"]), "cones": sum(lists["cones"])} if is_tiled else {}
        return cls(**means, **tiled, lines=_most_lines(lists, weights), unmapped=unmapped)


def verdict(quality: Quality, seen: Seen = Seen()) -> Verdict:
    """The `Verdict` on a map with this `Quality` as a texture that tiles shows it.

    The level is that of its cost to the eye, see `COSTS`, whatever covers what: overlaps are told by `baking`. The
    shear that evening added unseen does not count. `UNEVEN` and `SHEARED` are the
    limits of words.

    Raises AttributeError for what is no `Quality`.
    Source: ours; the limits were chosen on pictures of 46 models, docs/python/verdicts.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> quality = structure.quality(structure.uv(structure.balanced_coefficients()))
    >>> print(holomorph.verdict(quality).sentence)
    Uneven (squares of 1 to 2.1)
    """
    if not quality.area.any():
        return Verdict("unusable", "No texture is visible: the map has no area")
    shear = quality.mean_angle - quality.unseen_angle
    rank = _rank(total_cost(quality, seen) - of_overlaps(quality) - SHEAR_COST * quality.unseen_angle, COSTS)
    uneven = _rank(quality.size_range, UNEVEN)
    squares_of = f" (squares of 1 to {_factor(quality.size_range)})" if uneven > 1 else ""
    losses = {"flipped or collapsed": quality.lost_part, "without a map": seen.unmapped}
    words = [
        EVENNESS[uneven] + squares_of,
        _seams(seen),
        SHEAR[_rank(shear, SHEARED)],
        quality.direction and quality.direction.words,
        *(f"{percent(part)} {name}" for name, part in losses.items() if part > LOST),
        special(seen.poles, seen.turns, seen.cones, seen.lines),
        "the mesh is folded over itself" if seen.folded > FOLDED else None,
    ]
    sentence = ", ".join(filter(None, words))
    return Verdict(LEVELS[rank], sentence[0].upper() + sentence[1:])


def total_cost(quality: Quality, seen: Seen) -> float:
    """`appearance.cost` of a map of which this is seen besides its squares; what has no map counts as flipped."""
    blank = quality.lost_part - quality.flipped_part + seen.unmapped
    return cost(quality) + seen.cost + FLIPPED * blank


def baking(overlapping: float, tiled: float, used: float) -> Verdict:
    """The `Verdict` on a map as one into which textures are baked.

    overlapping : part of it that islands cover more than once; tiled : part of the area that has a tiling; used : part
        of the image that is covered
    """
    if tiled > 0:
        where = "this one" if tiled > 1 - LOST else f"{percent(tiled)} of this one"
        return Verdict("fair", f"Press Bake Tiling for a second map: on {where}, tiles lie on top of each other")
    rank, space = _rank(overlapping, OVERLAPPING), f"{percent(used)} of the image is used"
    overlaps = f"{percent(overlapping)} of it overlaps" if rank else "Nothing overlaps"
    return Verdict(LEVELS[max(rank, int(used < USED))], f"{overlaps}, {space}")


def told(report: Mapping[str, Any]) -> list[str]:
    """The sentences of a report on a mesh: what is seen of a texture that tiles, and what a bake meets."""
    found = {purpose: report[name]["sentence"] for name, purpose in PURPOSES.items() if report.get(name)}
    return [f"{purpose}: {sentence[0].lower()}{sentence[1:]}" for purpose, sentence in found.items()]


def special(poles: int | None, turns: int = 1, cones: int = 0, lines: str = "none") -> str | None:
    """The poles of tilings, or their turns, cones and lines, in words; None without tilings."""
    if poles is None:
        return None
    named = counted(poles, "pole") if poles else "no poles"
    if turns == 1:
        return named
    words = TURNED[turns], counted(cones, "cone") if cones else "no cones", LINED.get(lines), poles and named
    return ", ".join(filter(None, words))


def _most_lines(lists, weights):
    """The lines of nearly all of what turns, which a sentence about the whole may name."""
    turning = dict.fromkeys(("none", *lists["lines"]), 0.0)
    for lines, turns, weight in zip(lists["lines"], lists["turns"], weights):
        turning[lines] += weight if turns > 1 else 0.0
    most = max(turning, key=turning.get)
    return most if turning[most] >= NEARLY_ALL * sum(turning.values()) else "none"


def _rank(value, limits):
    """The first level whose limit is not exceeded; the last one for what is not a number."""
    return next((rank for rank, limit in enumerate(limits) if value <= limit), len(limits))


def _seams(seen):
    """Whether seams are in view, where that is known."""
    if seen.seams is None:
        return None
    if seen.seams > IN_VIEW:
        length = "short " if seen.seams <= SHORT else "long " if seen.seams > LONG else ""
        return f"{length}seams in view"
    if seen.hidden > IN_VIEW:
        return "seams at hard edges"
    return "no seams" if seen.poles is None else "seamless"


def _factor(value):
    """A factor in few digits, for a person."""
    return "over 1000" if value > 1000 else rounded(value)
