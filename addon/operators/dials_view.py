# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of the dials, in the sidebar and in the redo panel."""

import bpy

from .properties import OWN_TEXTURES, Dials

LABEL = 0.38  # of the width of a row: the words of other languages are longer


def row(layout, label):
    """A row with its label to the left; what is added to it stands behind the label."""
    split = layout.split(factor=LABEL)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=label)
    return split.row(align=True)


def dial(layout, dials, name, shown="", **options):
    """The row of a dial. shown : the property that is shown in its place"""
    made = row(layout, Dials.__annotations__[name].keywords["name"])
    made.prop(dials, shown or name, **({"text": ""} | options))
    return made


def draw_texture(layout, dials):
    """The row of the texture, and that of an image or a material of the user's."""
    made = dial(layout, dials, "texture")
    made.prop(dials, "checker", text="", icon="HIDE_OFF" if dials.checker else "HIDE_ON")
    if dials.texture in OWN_TEXTURES:
        row(layout, "").prop_search(dials, "source", bpy.data, OWN_TEXTURES[dials.texture], text="")


def draw(layout, dials):
    """The five dials of the redo panel."""
    draw_texture(layout, dials)
    dial(layout, dials, "size" if dials.size else "tiles", text="" if dials.size or dials.tiles else "Automatic")
    dial(layout, dials, "evenness", slider=True)
    dial(layout, dials, "turns")
    dial(layout, dials, "direction")
