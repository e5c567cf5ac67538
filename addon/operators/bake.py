# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that bakes what tilings show into images of an atlas."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import native
from .mixins import OnMeshes, WorkOperator
from .properties import items

CHANNELS = items(
    COLOUR="The base colour",
    ROUGHNESS="The roughness",
    METALLIC="The metallic",
    HEIGHT="The height of bumps or of displacement, in floating point",
    NORMAL="Normals in the tangent space of the baked UV map",
)
IMAGES = (
    ("EACH", "Per Object", "Images for each object"),
    ("ONE", "One Atlas", "All objects lie in the same images"),
    ("UDIM", "UDIM Tiles", "All objects share the images, each in a tile of its own"),
)
ABOUT = {
    "channels": "Channels to bake",
    "images": "How objects share images",
    "texels": "Texels per metre of the surface. 0: images of 2,048 texels a side",
    "margin": "Texels around islands, filled with the colours of their border so that seams do not show",
    "folder": "Folder for the images. Empty: pack them into the file",
}


class BakeProperties:
    """A mixin: what is baked, and into which images."""

    channels: EnumProperty(
        name="Channels",
        description=ABOUT["channels"],
        items=CHANNELS,
        options={"ENUM_FLAG"},
        default={"COLOUR", "ROUGHNESS", "NORMAL"},
    )
    images: EnumProperty(name="Images", description=ABOUT["images"], items=IMAGES, default="EACH")
    texels: FloatProperty(name="Texels / m", description=ABOUT["texels"], default=0.0, min=0.0)
    margin: IntProperty(name="Margin", description=ABOUT["margin"], default=8, min=0, soft_max=64)
    folder: StringProperty(name="Folder", description=ABOUT["folder"], subtype="DIR_PATH")


class HOLOMORPH_OT_bake(BakeProperties, OnMeshes, WorkOperator, bpy.types.Operator):
    """Bake what the seamless tilings of the selected meshes show into images that other programs read: a second UV map
    of islands that do not overlap, images, and a material that shows them. Restore Materials brings the others back"""

    bl_idname = "object.holomorphic_bake"
    bl_label = "Bake Tiling"
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    modes, left_modes = {"OBJECT": "Object Mode"}, frozenset()

    def draw_options(self, layout, _obj):
        layout.column().prop(self, "channels")
        for name in ("images", "texels", "margin", "folder"):
            layout.prop(self, name)

    def prepare(self, context):
        from ..baking import bake
        from ..scene import gathering

        self._options = bake.options(self)
        self._objects = bake.bakeable(gathering.mesh_objects(context))

    def make_work(self, progress):
        from ..baking import bake

        return bake.BakeWork(bpy.context, self._objects, self._options, progress)

    def waiting_faces(self):
        return self.modal_faces()

    def written_objects(self):
        return self._objects

    def finish(self, step, work, time_has_passed):
        from ..baking import write

        if work.error:
            return self.refuse(native.sentence(work.error))
        outcome = write.write(step, work, self._options)
        self.show(step.context, outcome, has_texture=True)
        return self.tell(outcome)


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_bake])
