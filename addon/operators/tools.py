# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for what is there already: materials brought back, heat maps, maps removed; and assets of the textures."""

import bpy

from .mixins import AtOnce, Explained


class HOLOMORPH_OT_restore_materials(AtOnce, bpy.types.Operator):
    """Bring back what was shown before: the materials that the checker or a texture covers, on all objects with the
    same mesh, the UV maps that were active in the editors and for renders, and the shading of the 3D views"""

    bl_idname = "uv.holomorphic_restore_materials"
    bl_label = "Restore Materials"
    needs_library, nothing = False, "There is nothing to restore"

    @classmethod
    def why_not(cls, _context):
        return ""

    def act(self, step, objects):
        from ..materials import material
        from ..results import restore

        restored = [restore.restore(obj) for obj in objects]
        material.restore_without_textures(step.context)
        return any(restored)


class HOLOMORPH_OT_heat(AtOnce, bpy.types.Operator):
    """Write how the active UV map distorts, as attributes of the faces of the selected meshes: "Holomorphic Density",
    the binary logarithm of UV area per surface area over its median, "Holomorphic Angle", s1 / s2, and "Holomorphic
    Direction", degrees from up"""

    bl_idname = "uv.holomorphic_heat"
    bl_label = "Holomorphic Heat Maps"
    nothing = "No UV map has faces"

    @classmethod
    def why_not(cls, context):
        from ..scene import gathering

        return "" if any(o.data.uv_layers for o in gathering.candidates(context)) else "Select a mesh with a UV map"

    def act(self, _step, objects):
        from ..results import heat

        objects = [o for o in objects if heat.is_possible(o)]
        for obj in objects:
            found = heat.write(obj)
            name = obj.data.uv_layers.active.name
            size, angle = f"size range {found.size_text}", f"angle distortion {found.mean_angle:.4f}"
            self.report({"INFO"}, f"{obj.name}, {name}: {size}, {angle}")
        return bool(objects)


class HOLOMORPH_OT_remove_maps(AtOnce, bpy.types.Operator):
    """Remove all maps named "Holomorphic" from the selected meshes, with their report, their material and the empties
    of their poles. Your materials and the UV map that was active before come back; seams and levels of detail stay"""

    bl_idname = "uv.holomorphic_remove_maps"
    bl_label = "Remove Maps"
    needs_library, nothing = False, "There are no maps to remove"

    def execute(self, context):
        result = super().execute(context)
        context.view_layer.update()  # or it lists empties that are gone
        return result

    def act(self, step, objects):
        from ..materials import material
        from ..results import restore

        has_removed = False
        for obj in {obj.data: obj for obj in reversed(objects)}.values():
            has_removed |= restore.remove_maps(step, obj)
        material.restore_without_textures(step.context)
        return has_removed


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
        from ..materials import nodes
        from ..writing import transaction

        with transaction.one_step(context, []):
            names = [material.name for material in nodes.add_assets()]
        if not names:
            return self.refuse("The materials are in the asset browser already")
        self.report({"INFO"}, f"Assets of this file: {', '.join(names)}")
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory(
    [
        HOLOMORPH_OT_restore_materials,
        HOLOMORPH_OT_heat,
        HOLOMORPH_OT_remove_maps,
        HOLOMORPH_OT_assets,
    ]
)
