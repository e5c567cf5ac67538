"""The map of a whole mesh: of which kinds its parts are, its figures over all faces, and the verdict on it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..quality.quality import Quality
from ..quality.verdicts import SMALL_PART, Verdict, overall

if TYPE_CHECKING:
    from ..mesh.repairs import Repairs
    from .map import Map

WORDS = {
    "tiling": "seamless",
    "islands": "in islands",
    "flat": "flat",
    "mixed": "partly seamless",
    "strip": "as a strip",
    "log": "around poles",
    "forms": "cut open",
    "disk": "round",
    "rectangle": "rectangular",
    "triangle": "triangular",
}
PLAIN = ("tiling", "forms")  # kinds that need no word where the mesh is one part: the verdict says the rest


@dataclass(frozen=True)
class Whole:
    """text : kinds of the parts, what was left out, cut and joined; "" for one part of which nothing is to be said
    mean_angle, size_range : as those of `Quality`, over all parts as they are arranged
    sizes : how many times as long squares of one part are as those of another at most, see `overall`
    unmapped_faces : number of faces without a map
    verdict : the `Verdict`
    """

    text: str
    mean_angle: float
    size_range: float
    sizes: float
    unmapped_faces: int
    verdict: Verdict


def whole(maps: Sequence[Map], parts: Sequence[dict[str, Any]], repairs: Repairs) -> Whole | None:
    """The `Whole` of a mesh; None where no part has a map.

    maps : of the parts that have one
    parts : the reports of all parts, and of the faces that were left out
    repairs : of the mesh
    """
    if not maps:
        return None
    areas = np.array([made.surface.area for made in maps])
    sizes = _sizes(maps)
    quality = Quality.joined([made.quality for made in maps], sizes)
    unmapped = sum(part["faces"] for part in parts if not part["done"])
    faces = sum(part["faces"] for part in parts)
    seen = sizes[(areas >= SMALL_PART * areas.sum()) & (sizes > 0)]
    spread = math.sqrt(seen.max() / seen.min()) if len(seen) else 1.0
    order = np.argsort(-areas, kind="stable")
    found = overall([maps[k].verdict for k in order], areas[order], sizes=spread, unmapped=unmapped / faces)
    text = "; ".join(_words(maps, unmapped, repairs))
    return Whole(text, quality.mean_angle, quality.size_range, spread, unmapped, found)


def _sizes(maps):
    """(n,) median densities as arranged: all but tilings are scaled to one."""
    tiled = [made.density for made in maps if made.is_tiled]
    unit = np.median(tiled) if tiled else 1.0
    return np.array([made.density / unit if made.is_tiled and unit > 0 else float(made.density > 0) for made in maps])


def _words(maps, unmapped, repairs):
    kinds = Counter(made.kind for made in maps)
    if len(maps) > 1:
        yield f"{len(maps):,} parts: " + ", ".join(f"{count:,} {WORDS[kind]}" for kind, count in kinds.most_common())
    elif maps[0].kind not in PLAIN:
        yield WORDS[maps[0].kind]
    if unmapped:
        yield f"{unmapped:,} faces left out" if unmapped > 1 else "1 face left out"
    yield from (cut.sentence for cut in repairs.cuts)
    yield from repairs.notes
    if len(repairs.joined_vertices):
        yield f"{len(repairs.joined_vertices):,} vertices joined"
