# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that submits a library of assets to a render farm."""

import bpy
from bpy.props import IntProperty, StringProperty

from . import flamenco
from .availability import Explained


class HOLOMORPH_OT_submit(Explained, bpy.types.Operator):
    """Map a library of meshes on the render farm: a folder of mesh files and .blend files, or this file as it is saved.
    The manager needs the job type holomorph-uv-maps.js, the workers the command holomorph"""

    bl_idname = "wm.holomorphic_submit"
    bl_label = "Submit to Flamenco"
    bl_options = {"REGISTER"}

    sources: StringProperty(
        name="Sources", description="Folder, file, pattern or list; empty for this file", subtype="FILE_PATH"
    )
    output: StringProperty(name="Output", description="Folder for the results", subtype="DIR_PATH", default="//maps")
    recipe: StringProperty(name="Recipe", description="TOML file; empty for the defaults", subtype="FILE_PATH")
    shares: IntProperty(name="Tasks", description="Number of tasks that share the work", default=8, min=1, max=1000)

    needs_library, modes = False, {}

    @classmethod
    def why_not(cls, _context):
        return "" if flamenco.reachable() else "No Flamenco Manager answers"

    def invoke(self, context, event):
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        sources = self.sources or bpy.data.filepath
        if not sources:
            return self.refuse("Save the file first, or name the sources")
        paths = {"sources": sources, "output": self.output, "recipe": self.recipe}
        settings = {name: bpy.path.abspath(path) for name, path in paths.items()} | {"shares": self.shares}
        try:
            number = flamenco.submit(flamenco.reachable(), f"Holomorph: {bpy.path.basename(sources)}", settings)
        except flamenco.Unreachable as error:
            return self.refuse(error)
        self.report({"INFO"}, f"Submitted to Flamenco as job {number}")
        return {"FINISHED"}


def draw(layout):
    """Its button, where a manager answers."""
    if flamenco.reachable():
        layout.operator(HOLOMORPH_OT_submit.bl_idname, icon="NETWORK_DRIVE")


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_submit])
