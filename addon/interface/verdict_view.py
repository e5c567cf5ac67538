# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: words, what would help, plain numbers."""

import functools
import math
from typing import NamedTuple

from ..native import holomorph
from ..results import stored, symmetric
from . import lines

REPAIR = "mesh.holomorphic_repair"
SYMMETRIC = "uv.holomorphic_make_symmetric"
SHOWN_TURNS = "This texture shows its turns: seams are seen where the map turns"
EDITED = "Before the last edit:"
ICONS = {"good": "CHECKMARK", "fair": "NONE", "poor": "ERROR", "unusable": "ERROR"}


def draw(layout, context, text, tile_operator, is_edited=False):
    """Out of a stored report; the operator is offered where seams are in view, and where poles would help.

    is_edited : whether the mesh is another than then: the verdict has no tick
    """
    read_of = read(text)
    if read_of is None:
        return
    box = layout.box().column(align=True)
    if read_of.whole:
        lines.draw(box, context, read_of.whole)
    if read_of.joined:  # Blender's own operator is grey outside of Edit Mode
        box.operator(REPAIR, text=f"Merge {read_of.joined:,} Vertices").kinds = {"WELD"}
    if is_edited:
        lines.draw(box, context, EDITED, "INFO")
    for level, sentence in zip(read_of.levels, read_of.told):
        lines.draw(box, context, sentence, "NONE" if is_edited else ICONS[level])
    if symmetric.shown_turns(text):
        lines.draw(box, context, SHOWN_TURNS, "INFO")
        box.operator(SYMMETRIC)
    if read_of.places:
        lines.draw(box, context, read_of.places)
        box.operator(tile_operator, text="Add Poles There").poles = "COARSE"
    elif read_of.has_seams:
        box.operator(tile_operator, text="Make It Seamless")
    for name, value in read_of.numbers:
        row = box.split(factor=0.72)
        row.label(text=name)
        row.label(text=value)


class Read(NamedTuple):
    """What a panel shows of a stored report.

    joined : vertices that were joined for the maps, and are apart in the mesh; levels, told : of the verdicts
    has_seams : in view; places : sentence about coarse ones; numbers : see there
    """

    whole: str
    joined: int
    levels: list
    told: list
    has_seams: bool
    places: str
    numbers: list


@functools.lru_cache(maxsize=16)
def read(text):
    """The `Read` of a stored report; None if there is none, or someone has edited it."""
    entry = stored.parsed(text)
    try:
        found, places = stored.verdicts(entry), entry.get("coarse_places")
        if not found:
            return None
        coarse = stored.coarse_sentence(places) if places else ""
        levels, told = [one.level for one in found], holomorph.quality.verdicts.told(entry)
        joined, seams = stored.joined(entry), entry["whole"]["seams"] or 0.0
        has_seams = seams > holomorph.quality.verdicts.IN_VIEW
        return Read(stored.whole(entry), joined, levels, told, has_seams, coarse, numbers(entry))
    except (KeyError, TypeError, IndexError, AttributeError):
        return None


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
