# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes assets of the textures' materials."""

import bpy

from .mixins import Explained


class HOLOMORPH_OT_assets(Explained, bpy.types.Operator):
    """Make a material of each texture and mark it as an asset of this file: drag one from the asset browser onto any
    object that has a seamless tiling"""

    bl_idname = "object.holomorphic_assets"
    bl_label = "Add to Asset Browser"
    needs_library = False

    @classmethod
    def why_not(cls, _context):
        return ""

    def execute(self, context):
        from ..materials import assets
        from ..writing import transaction

        with transaction.one_step(context, []):
            names = [material.name for material in assets.add()]
        if not names:
            return self.refuse("The materials are in the asset browser already")
        self.report({"INFO"}, f"Assets of this file: {', '.join(names)}")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_assets])
