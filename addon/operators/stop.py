# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that ends work in the background, as ESC does."""

import bpy

from .mixins import WorkOperator


class HOLOMORPH_OT_stop(bpy.types.Operator):
    """Stop, and leave everything as it was"""

    bl_idname = "uv.holomorphic_stop"
    bl_label = "Stop"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context):
        return WorkOperator.running is not None

    def execute(self, _context):
        WorkOperator.running.watch.cancel()
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_stop])
