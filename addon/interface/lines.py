# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in a panel, broken so that no line is clipped."""

import blf

from . import words

FONT = 0
BESIDE = 66  # pixels of a sidebar's width that are not text, in a user interface of normal size: tabs, margins, box
ICON = 26  # likewise, of an icon


def draw(layout, context, text, icon="NONE", indent=0):
    """Labels with the words of a sentence, in the user's language, the icon before the first; `indent` is that of
    further lines, in spaces."""
    for line in broken(words.said(text), fits(context, icon != "NONE"), indent):
        layout.label(text=line, icon=icon)
        icon = "BLANK1" if icon != "NONE" else icon


def broken(text, is_fit, indent=0):
    """Lines of as many words as fit."""
    line, *others = text.split(" ")
    for word in others:
        if line.strip() and not is_fit(f"{line} {word}"):
            yield line
            line = " " * indent + word
        else:
            line += f" {word}"
    yield line


def fits(context, has_icon):
    """Whether a text is no wider than a line of the region."""
    unit = context.preferences.system.ui_scale
    room = context.region.width - (BESIDE + has_icon * ICON) * unit

    def is_fit(text):
        blf.size(FONT, context.preferences.ui_styles[0].widget.points * unit)
        return blf.dimensions(FONT, text)[0] <= room

    return is_fit
