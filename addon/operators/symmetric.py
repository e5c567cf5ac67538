# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that lets images and materials of the user's look the same after the turns of their map."""

import bpy

from .mixins import AtOnce


class HOLOMORPH_OT_make_symmetric(AtOnce, bpy.types.Operator):
    """Let your own image or material look the same after the turns of the seamless map that shows it, so that no seam
    is left: its parts go softly over into turned ones. A copy is shown; the image and the material stay as they are"""

    bl_idname = "uv.holomorphic_make_symmetric"
    bl_label = "Make Symmetric"
    nothing = "No texture of yours shows the turns of its map"

    def act(self, step, objects):
        from ..materials import material
        from ..results import symmetric

        coverings = {}
        told = [symmetric.make(obj, coverings) for obj in objects]
        for sentence in filter(None, told):
            self.report({"WARNING"}, sentence)
        step.discard(material.unused_copies())
        return "" in told


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_make_symmetric])
