# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels have besides the two buttons and the result."""

from . import evaluated
from .operators import HOLOMORPH_OT_maps


def draw_modifiers(layout, obj):
    """The button again, for an object whose modifiers change its shape."""
    if evaluated.first_of(obj):
        if not len(obj.data.polygons):
            layout.label(text="Only its modifiers make faces", icon="INFO")
        layout.operator(HOLOMORPH_OT_maps.bl_idname, text="Map with Modifiers", icon="MODIFIER").modifiers = True
