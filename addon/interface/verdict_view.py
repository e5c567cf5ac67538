# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: words, what would help, plain numbers."""

import functools
import math
from typing import NamedTuple

from ..native import holomorph
from ..results import stored, symmetric
from . import lines

SYMMETRIC = "uv.holomorphic_make_symmetric"
SHOWN_TURNS = "This texture shows its turns: seams are seen where the map turns"
EDITED = "Before the last edit:"
ICONS = {"good": "CHECKMARK", "fair": "NONE", "poor": "ERROR", "unusable": "ERROR"}


def draw(layout, context, text, tile_operator, is_edited=False):
    """Out of a stored report; the operator is offered where poles might help.

    is_edited : whether the mesh is another than then: the verdict has no tick
    """
    read_of = read(text)
    if read_of is None:
        return
    box = layout.box().column(align=True)
    if read_of.whole:
        lines.draw(box, context, read_of.whole)
    if is_edited:
        lines.draw(box, context, EDITED, "INFO")
    for level, sentence in zip(read_of.levels, read_of.told):
        lines.draw(box, context, sentence, "NONE" if is_edited else ICONS[level])
    if symmetric.shown_turns(text):
        lines.draw(box, context, SHOWN_TURNS, "INFO")
        box.operator(SYMMETRIC)
    if read_of.places:
        lines.draw(box, context, read_of.places)
        pressed = box.operator(tile_operator, text="Try Poles There")
        pressed.poles, pressed.is_trial = "COARSE", True
    for name, value in read_of.numbers:
        row = box.split(factor=0.72)
        row.label(text=name)
        row.label(text=value)


class Read(NamedTuple):
    """What a panel shows of a stored report.

    levels, told : of the verdicts; places : sentence about coarse ones; numbers : see there
    """

    whole: str
    levels: list
    told: list
    places: str
    numbers: list


@functools.lru_cache(maxsize=16)
def read(text):
    """The `Read` of a stored report; None if there is none."""
    entry = stored.parsed(text)
    if not entry:
        return None
    places = entry.get("coarse_places")
    coarse = stored.coarse_sentence(places) if places else ""
    levels, told = [one.level for one in stored.verdicts(entry)], holomorph.quality.verdicts.told(entry)
    return Read(stored.whole(entry), levels, told, coarse, numbers(entry))


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
