# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: words, what would help, plain numbers."""

import math
import textwrap

from . import coarse, report

ICONS = {"good": "CHECKMARK", "fair": "CHECKMARK", "poor": "ERROR", "unusable": "ERROR"}


def draw(layout, stored, width, tile_operator):
    """Out of a stored report; `width` in characters, `tile_operator` is offered where poles would help."""
    entry = report.parsed(stored)
    found = report.verdict(entry)
    if not found:
        return
    box = layout.box().column(align=True)
    _draw_wrapped(box, found.sentence, width, ICONS[found.level])
    if entry.get("coarse_places"):
        _draw_wrapped(box, coarse.sentence(entry["coarse_places"]), width)
        box.operator(tile_operator, text="Add Poles There").poles = "COARSE"
    elif found.advice and not found.is_fit:
        _draw_wrapped(box, f"Try: {found.advice}", width)
    for name, value in numbers(entry):
        row = box.split(factor=0.7)
        row.label(text=name)
        row.label(text=value)


def numbers(entry):
    """(name, value) of what is measured: the largest of the parts, or the sum of what is counted."""
    measured = [part["main_map"] for part in entry["components"] if part["done"]]
    if not measured:
        return []
    ratio = max(math.inf if one["density_ratio"] is None else one["density_ratio"] for one in measured)
    shear = max(one["capped_mean_angle"] for one in measured)
    return [
        ("Largest : smallest square", f"{math.sqrt(ratio):.1f}" if ratio < 1e6 else "over 1000"),
        ("Long : wide of squares", f"{shear:.2f}"),
        ("Flipped triangles", str(sum(one["flipped_triangles"] for one in measured))),
        ("Collapsed triangles", str(sum(one["collapsed_triangles"] for one in measured))),
    ]


def _draw_wrapped(layout, text, width, icon="NONE"):
    for line in textwrap.wrap(text, width):
        layout.label(text=line, icon=icon)
        icon = "BLANK1" if icon != "NONE" else icon
