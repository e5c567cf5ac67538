"""Verdicts on UV maps, in words: one judgement for the package, its command and Blender."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.value import counted
from ..mesh.checks import ratio

if TYPE_CHECKING:
    from .quality import Quality

LEVELS = ("good", "fair", "poor", "unusable")

# The largest values of all levels but the last. They were chosen on pictures of 63 meshes, see docs/python/verdicts.md.
UNEVEN = (3.16, 6.32, 31.6)  # size range: the root of 10, 40 and 1000 in density
SHEARED = (1.15, 1.4, 2.5)  # angle distortion
UNSEEN = 0.3  # angle distortion that evening may add unseen at evenness 1: it is spread out, and squares have one size
LOST = (0.002, 0.01, 0.05)  # part of the area that is flipped or has collapsed
SMALL_PART = 0.01  # part of the area of all parts: worse maps of less do not decide
SAME_SIZE = 1.049  # largest over smallest side of squares of parts that is not seen: 10 % in area
OVERLAPPING = (1e-6, 0.01, 0.2)  # part of an island that covers itself: less is rounding; it can be textured, not baked

TURNED = {2: "half turns", 4: "quarter turns", 6: "sixth turns"}  # of tilings, by `Tiling.turns`
LINED = {"free": "rows run along edges", "whole": "rows end at edges"}  # by `Tiling.lines`
EVENNESS = ("even", "fairly even", "uneven", "very uneven")
SHEAR = (None, "slightly sheared", "sheared", "badly sheared")
LONG = 10.0  # square of the longest side over twice the area of a long thin triangle; 1.2 where it is equilateral
MOSTLY = 0.5  # part of the area that is
ADDED = 1.05  # angle distortion that a tiling's whole numbers add, from which on more tiles would show
ISLANDS = "or unwrap it in islands along its hard edges"
OVERLAP_ADVICE = "mark one more seam across the island"


@dataclass(frozen=True)
class Verdict:
    """level: one of `LEVELS`; sentence: what is seen of a texture; advice: what would help, "" where nothing need."""

    level: str
    sentence: str
    advice: str

    @property
    def is_fit(self) -> bool:
        """Whether a texture can be put on: the level is good or fair."""
        return self.rank <= LEVELS.index("fair")

    @property
    def rank(self) -> int:
        """The place of the level in `LEVELS`."""
        return LEVELS.index(self.level)

    @property
    def offers_islands(self) -> bool:
        """Whether islands along hard edges would help: the mesh is too coarse for a conformal map of the whole."""
        return ISLANDS in self.advice

    @property
    def text(self) -> str:
        """Sentence and advice."""
        return self.sentence + (f": {self.advice}" if self.advice else "")


def verdict(
    quality: Quality,
    poles: int | None = None,
    added_distortion: float = 1.0,
    *,
    turns: int = 1,
    cones: int = 0,
    lines: str = "none",
) -> Verdict:
    """The `Verdict` on a map with this `Quality`.

    The worst counts: the size range, how far squares are sheared, which part of the surface is flipped or
    has collapsed, and which part of an island covers itself. `UNEVEN`, `SHEARED`, `LOST`, `OVERLAPPING` are the limits.
    Of the shear that evening added, what is not seen does not count.

    poles, added_distortion : of a seamless tiling, how many it has, and `Tiling.added_distortion`; None for other maps
    turns, cones, lines : of a tiling that turns, `Tiling.turns`, how many cones it has, and `Tiling.lines`

    Raises ValueError for an added distortion that is no number.
    Source: ours; the limits were chosen on pictures of 63 meshes, docs/python/verdicts.md.

    Examples
    --------
    >>> surface = holomorph.Surface.read("examples/pretzel.obj")
    >>> structure = holomorph.conformal_structure(surface)
    >>> quality = structure.quality(structure.uv(structure.balanced_coefficients()))
    >>> print(holomorph.verdict(quality).text)
    Even
    """
    if not quality.area.any():
        return Verdict("unusable", "No texture is visible: the map has no area", "unwrap it again")
    ranks = [
        _rank(quality.size_range, UNEVEN),
        _rank(quality.mean_angle - quality.unseen_angle, SHEARED),
        _rank(quality.lost_part, LOST),
        _rank(quality.overlapping_part or 0.0, OVERLAPPING),
    ]
    worst = max(ranks)
    against_shear = _against_shear(quality, ratio(added_distortion, "added_distortion"), worst, turns)
    is_island = quality.overlapping_part is not None
    advice = (_against_unevenness(poles, is_island, turns), against_shear, _against_losses(quality), OVERLAP_ADVICE)
    wanted = [text for text, rank in zip(advice, ranks) if rank == worst > 0]
    more_exact = [text for text in wanted if not any(other.startswith(f"{text} ") for other in wanted)]
    decisive = [text for text in more_exact if ISLANDS in text]  # nothing else helps a mesh that is so coarse
    sentence = _sentence(quality, special(poles, turns, cones, lines), ranks)
    return Verdict(LEVELS[worst], sentence, "; ".join(decisive or more_exact))


def overall(
    verdicts: Sequence[Verdict], areas: ArrayLike | None = None, *, sizes: float = 1.0, unmapped: float = 0.0
) -> Verdict:
    """The `Verdict` on a mesh: that of its worst part, the first of several, and how many parts are on its level.

    areas : (n,) of the parts, equal by default. Worse parts that have less than `SMALL_PART` of the area together are
        named, and do not decide
    sizes : how many times as long squares of one part are as those of another at most; from `SAME_SIZE` on no texture
        fits all parts
    unmapped : part of the faces that has no map, to which the limits `LOST` apply

    Raises ValueError for other shapes, for negative areas, and for numbers that are none.
    Source: ours; the limits were chosen on pictures of 63 meshes, docs/python/verdicts.md.

    Examples
    --------
    >>> good, poor = holomorph.Verdict("good", "Even", ""), holomorph.Verdict("poor", "Uneven", "add poles")
    >>> print(holomorph.overall([good, poor], [99.5, 0.5]).sentence)
    Even; 1 small part is poor
    """
    areas = np.ones(len(verdicts)) if areas is None else arrays.numbers(areas, "areas")
    if areas.shape != (len(verdicts),) or not (areas >= 0).all():
        raise ValueError(f"areas has the shape {areas.shape}; ({len(verdicts)},) numbers from 0 on are needed")
    sizes, unmapped = ratio(sizes, "sizes"), ratio(unmapped, "unmapped")
    ranks = np.array([each.rank for each in verdicts])
    rank = next(r for r in np.unique(ranks)[::-1] if areas[ranks >= r].sum() >= SMALL_PART * areas.sum())
    first = verdicts[int(np.argmax(ranks == rank))]
    found = [(rank, _on_parts(first, ranks, rank), first.advice)]
    if unmapped:
        found.append((_rank(unmapped, LOST), f"{_percent(unmapped)} of the faces have no map", ""))
    if sizes > SAME_SIZE:
        told = f"squares differ in size between parts by a factor of {_factor(sizes)}"
        found.append((LEVELS.index("poor"), told, "ask for more tiles"))
    if ranks.max() > rank:
        count = int(np.count_nonzero(ranks > rank))
        found.append((rank, f"{count} small part{'s are' if count > 1 else ' is'} {LEVELS[ranks.max()]}", ""))
    levels, words, advice = zip(*found)
    return Verdict(LEVELS[max(levels)], "; ".join(words), "; ".join(filter(None, advice)))


def _on_parts(chosen, ranks, rank):
    """The sentence of a verdict, and on how many parts of several it is so."""
    count = int(np.count_nonzero(ranks == rank))
    if count == np.count_nonzero(ranks <= rank):
        return chosen.sentence
    return f"{count} of {len(ranks)} parts {'is' if count == 1 else 'are'} {LEVELS[rank]}: {_lower(chosen.sentence)}"


def _rank(value, limits):
    """The first level whose limit is not exceeded; the last one for what is not a number."""
    return next((rank for rank, limit in enumerate(limits) if value <= limit), len(limits))


def special(poles: int | None, turns: int = 1, cones: int = 0, lines: str = "none") -> str | None:
    """The poles of a tiling, or its turns, cones and lines, in words; None for other maps."""
    if poles is None:
        return None
    if turns != 1:
        words = (TURNED[turns], counted(cones, "cone") if cones else "no cones", LINED.get(lines))
        return ", ".join(filter(None, words))
    return counted(poles, "pole") if poles else "no poles"


def _sentence(quality, named, ranks):
    uneven, sheared, lost, overlapping = ranks
    words = [EVENNESS[uneven], named and "seamless", SHEAR[sheared]]
    if uneven > 1:
        words[0] += f" (squares of 1 to {_factor(quality.size_range)})"
    if lost:
        words.append(f"{_percent(quality.lost_part)} flipped or collapsed")
    if overlapping:
        words.append(f"{_percent(quality.overlapping_part)} of the island overlaps itself")
    sentence = ", ".join(word for word in (*words, named) if word)
    return sentence[0].upper() + sentence[1:]


def _lower(sentence):
    return sentence[0].lower() + sentence[1:]


def _factor(value):
    """A factor in few digits, for a person."""
    return "over 1000" if value > 1000 else f"{float(f'{value:.2g}'):g}"


def _percent(part):
    return f"{100 * part:.2g} %"


def _against_unevenness(poles, is_island, turns):
    if is_island:
        return "mark a seam up to where it is coarse, or set Most Stretch"
    if turns != 1:
        return "ask for more tiles"
    return "add poles where it is coarse" if poles else "make a seamless tiling, with poles where it is coarse"


def _against_shear(quality, added_distortion, rank, turns):
    is_slight = rank <= LEVELS.index("fair")
    if added_distortion > ADDED or (turns != 1 and is_slight):  # cones lie on few centres of large tiles
        return "ask for more tiles"
    if is_slight:
        return "subdivide the mesh"
    if quality.long_part > MOSTLY:
        return f"remesh its long thin faces, {ISLANDS}"
    return f"subdivide the mesh, which is too coarse for a conformal map, {ISLANDS}"


def _against_losses(quality):
    if np.count_nonzero(quality.flipped) > np.count_nonzero(quality.collapsed):
        return "subdivide the mesh where faces are flipped"
    return "subdivide the mesh where faces have collapsed"
