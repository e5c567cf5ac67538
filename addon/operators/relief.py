# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that raises a picture on the tiles of a surface, to be printed or sculpted."""

import bpy
from bpy.props import FloatProperty, IntProperty, StringProperty

from .geometry import OnTiling
from .properties import ONCE

MILLIMETRES = 1000.0  # in a metre
ABOUT = {
    "image": "Image to raise once in every tile: the brighter, the higher",
    "depth": "Height of white over black, in millimetres by the scene's units; without units, one unit is 1 mm. 0: a "
    "tenth of a tile",
    "repeats": "Number of images across a tile; 0 for as many as the material shows",
    "level": "Grey level that stays on the surface: 0 raises, 1 engraves",
    "tolerance": "Largest error of the triangles, from 0 to 1 of the depth",
    "most_triangles": "Limit on the triangles; those with the largest errors are halved first",
}


class HOLOMORPH_OT_relief(OnTiling, bpy.types.Operator):
    """Make a copy of the active mesh with an image raised on it, once in every tile of its seamless tiling. It is
    refined where the image needs it, closes up around every limb, and is closed if the mesh is"""

    bl_idname = "object.holomorphic_relief"
    bl_label = "Relief"
    may_turn = False

    image: StringProperty(name="Image", description=ABOUT["image"], options=ONCE)
    depth: FloatProperty(
        name="Depth (mm)", description=ABOUT["depth"], default=0.0, min=0.0, soft_max=100.0, precision=3
    )
    repeats: IntProperty(name="Repeats", description=ABOUT["repeats"], default=0, min=0, soft_max=16, max=1000)
    level: FloatProperty(name="Level", description=ABOUT["level"], default=0.0, min=0.0, max=1.0)
    tolerance: FloatProperty(name="Tolerance", description=ABOUT["tolerance"], default=0.02, min=0.0, max=1.0)
    most_triangles: IntProperty(
        name="Most Triangles", description=ABOUT["most_triangles"], default=1_000_000, min=1, soft_max=10_000_000
    )

    def draw_options(self, layout, _obj):
        layout.prop_search(self, "image", bpy.data, "images")
        for name in ("depth", "repeats", "level", "tolerance", "most_triangles"):
            layout.prop(self, name)

    def prepare(self, context):
        from ..scene import image_io
        from ..things import geometry, relief

        super().prepare(context)
        obj = context.view_layer.objects.active
        shown, repeats = relief.shown_heights(obj.active_material)
        image = bpy.data.images.get(self.image) if self.image else shown
        if image is None:
            raise ValueError("choose the image to raise")
        self._repeats = self.repeats or (repeats if image == shown else 1)
        try:
            self._heights = relief.heights_of(image_io.read_file_values(image), relief.channel_weights(image))
        except ValueError as error:
            raise ValueError(f"{image.name}: {error}") from error
        if image == shown:
            self._heights = relief.about_centre(self._heights, obj.active_material)
        self._millimetres = _millimetres(context.scene.unit_settings)
        self._is_turned = geometry.is_mirrored(obj)

    def make_work(self, progress):
        from ..things import relief

        polygons, uv, lattice, turns = self._source
        if self._is_turned:
            polygons, uv = relief.turned_over(polygons, uv)
        names = ("level", "tolerance", "most_triangles")
        return relief.RaisingWork(
            polygons,
            uv,
            lattice,
            turns,
            None,
            progress,
            heights=self._heights,
            depth=self.depth / self._millimetres,
            options={name: getattr(self, name) for name in names} | {"repeats": self._repeats},
        )

    def finish(self, step, work, time_has_passed):
        self._work_done = work
        return super().finish(step, work, time_has_passed)

    def write(self, step, obj, found):
        from ..things import geometry, relief

        made = geometry.write_relief(step, obj, found[0])
        return f"{made.name}: {relief.sentence(found[0], self._millimetres, self._work_done)}"


def _millimetres(units):
    """Millimetres in a unit of Blender's."""
    return 1.0 if units.system == "NONE" else MILLIMETRES * units.scale_length


register, unregister = bpy.utils.register_classes_factory([HOLOMORPH_OT_relief])
