# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

import bpy
from bpy.props import BoolProperty


class HOLOMORPH_preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    show_in_viewport: BoolProperty(
        name="Show the Result in the 3D View",
        description="After mapping, show the texture in the 3D views of this window that are in solid or wireframe "
        "shading; Restore Materials brings their shading back",
        default=True,
    )

    research: BoolProperty(
        name="Research",
        description="Show the dials of single forms and of the solver in the sidebar",
        default=False,
    )

    def draw(self, _context):
        self.layout.prop(self, "show_in_viewport")
        self.layout.prop(self, "research")


def of(context):
    """The preferences; None where the add-on is not enabled as one."""
    addon = context.preferences.addons.get(HOLOMORPH_preferences.bl_idname)
    return None if addon is None else addon.preferences


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_preferences])
