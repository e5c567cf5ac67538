# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: whether it is ready to tile and to bake, what is seen, what would help."""

import functools
import math
import re
from typing import NamedTuple

from ..results import stored
from . import lines

TILE, BAKE = "uv.holomorphic_tile", "object.holomorphic_bake"
EDITED = "Before the last edit:"
TILES_OVERLAP = "Tiles lie on top of each other"
UNSAID = re.compile(r"\b(poles?|cones?|turns)\b")  # what the row of the points and that of the turns show
HEADINGS = {"verdict": "tile", "bake": "bake"}


def draw(layout, context, text, is_edited=False):
    """Out of a stored report.

    is_edited : whether the mesh is another than then: nothing has a tick
    """
    read_of = read(text)
    if read_of is None:
        return
    column = layout.column(align=True)
    if is_edited:
        lines.draw(column, context, EDITED, "INFO")
    for judged in read_of.judged:
        icon = "NONE" if is_edited else judged.icon
        lines.draw(column, context, judged.heading, icon)
        for sentence in judged.sentences:
            lines.draw(column, context, sentence, "BLANK1")
        if judged.purpose == "bake" and read_of.is_tiled:
            column.operator(BAKE, icon="RENDER_STILL")
        column.separator()
    if read_of.places:
        lines.draw(column, context, read_of.places, "BLANK1")
        pressed = column.operator(TILE, text="Try Points There")
        pressed.poles, pressed.is_trial = "COARSE", True


class Judged(NamedTuple):
    """One of the verdicts. icon : of its heading"""

    purpose: str
    heading: str
    sentences: tuple
    icon: str


class Read(NamedTuple):
    """What a panel shows of a stored report.

    places : sentence about coarse ones; is_tiled : whether tiles of parts lie on top of each other
    """

    judged: list
    places: str
    is_tiled: bool


@functools.lru_cache(maxsize=16)
def read(text):
    """The `Read` of a stored report; None if there is none."""
    entry = stored.parsed(text)
    if not entry:
        return None
    is_tiled, places = bool(stored.tilings(text)), entry.get("coarse_places")
    judged = [_judged(name, one, entry, is_tiled) for name, one in zip(HEADINGS, stored.verdicts(entry))]
    return Read(judged, stored.coarse_sentence(places) if places else "", is_tiled)


def _judged(name, verdict, entry, is_tiled):
    if name == "bake" and is_tiled:
        return Judged(name, "Not ready to bake", (TILES_OVERLAP,), "INFO")
    said = ", ".join(words for words in verdict.sentence.split(", ") if not UNSAID.search(words))
    whole = stored.whole(entry) if name == "verdict" else ""
    heading = f"{'Ready' if verdict.is_fit else 'Not ready'} to {HEADINGS[name]}"
    return Judged(name, heading, tuple(filter(None, (said, whole))), "CHECKMARK" if verdict.is_fit else "ERROR")


def numbers(entry):
    """(name, value) of what is measured over the whole object, and the sums of what is counted."""
    measured, whole = [part["main_map"] for part in entry["components"] if part["done"]], entry["whole"]
    size = math.inf if whole["size_range"] is None else whole["size_range"]
    return [
        ("Size range", f"{size:.3g} : 1" if size < 1000 else "1000+"),
        ("Angle distortion", f"{whole['mean_angle']:.2f} : 1"),
        ("Flipped triangles", str(sum(one["flipped_triangles"] for one in measured))),
        ("Collapsed triangles", str(sum(one["collapsed_triangles"] for one in measured))),
    ]
