# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on an object's map in a panel: whether it is ready to tile and to bake, what is seen, what would help."""

from . import lines

TILE, BAKE = "uv.holomorphic_tile", "object.holomorphic_bake"
EDITED = "Before the last edit:"


def draw(layout, context, made, is_edited=False):
    """Out of what `stored_dials.made` gives.

    is_edited : whether the mesh is another than then: nothing has a tick
    """
    column = layout.column(align=True)
    if is_edited:
        lines.draw(column, context, EDITED, "INFO")
    tile = "tile", made.is_fit, made.sentence, made.whole
    for purpose, is_fit, *sentences in (tile, ("bake", made.is_bake_fit, made.bake_sentence)):
        has_remedy = purpose == "bake" and made.is_tiled
        icon = "CHECKMARK" if is_fit else "INFO" if has_remedy else "ERROR"
        heading = f"{'Ready' if is_fit else 'Not ready'} to {purpose}"
        lines.draw(column, context, heading, "NONE" if is_edited else icon)
        for sentence in filter(None, sentences):
            lines.draw(column, context, sentence, "BLANK1")
        if has_remedy:
            column.operator(BAKE, icon="RENDER_STILL")
        column.separator()
    if made.coarse:
        lines.draw(column, context, made.coarse, "BLANK1")
        pressed = column.operator(TILE, text="Try Points There")
        pressed.poles, pressed.is_trial = "COARSE", True
