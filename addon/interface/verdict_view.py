# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: words, what would help, plain numbers."""

import functools
import math

from ..results import stored
from . import lines

REPAIR = "mesh.holomorphic_repair"
EDITED = "Before the last edit:"
ICONS = {"good": "CHECKMARK", "fair": "CHECKMARK", "poor": "ERROR", "unusable": "ERROR"}


def draw(layout, context, text, tile_operator, islands_operator, is_edited=False):
    """Out of a stored report; the operators are offered where poles would help, and islands.

    is_edited : whether the mesh is another than then: the verdict has no tick
    """
    whole, is_joined, found, places, measured = read(text)
    if found is None:
        return
    box = layout.box().column(align=True)
    if whole:
        lines.draw(box, context, whole)
    if is_joined:
        box.operator(REPAIR, text="Merge by Distance").kinds = {"WELD"}  # Blender's own is grey outside of Edit Mode
    if is_edited:
        lines.draw(box, context, EDITED, "INFO")
    lines.draw(box, context, found.sentence, "NONE" if is_edited else ICONS[found.level])
    if places:
        lines.draw(box, context, places)
        box.operator(tile_operator, text="Add Poles There").poles = "COARSE"
    elif found.advice and not found.is_fit:
        lines.draw(box, context, f"Try: {found.advice}")
    if found.offers_islands and not found.is_fit:
        box.operator(islands_operator)
    for name, value in measured:
        row = box.split(factor=0.72)
        row.label(text=name)
        row.label(text=value)


NOTHING = "", False, None, "", []


@functools.lru_cache(maxsize=16)
def read(text):
    """(`stored.whole`, `stored.is_joined`, `Verdict`, sentence about coarse places, `numbers`) out of a stored report;
    `NOTHING` if there is none, or someone has edited it."""
    entry = stored.parsed(text)
    try:
        found, places = stored.verdict(entry), entry.get("coarse_places")
        if found is None:
            return NOTHING
        told = stored.coarse_sentence(places) if places else ""
        return stored.whole(entry), stored.is_joined(entry), found, told, numbers(entry)
    except (KeyError, TypeError, IndexError, AttributeError):
        return NOTHING


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
