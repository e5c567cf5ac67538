# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for what is there already: materials brought back, heat maps, maps removed, bad elements selected."""

import bpy
from bpy.props import EnumProperty, FloatProperty

from .mixins import AtOnce

KINDS = (
    (
        "CUT",
        "Cut",
        "Edges with more than two faces or on one-sided parts; faces that occur twice, have two sides or meet a "
        "vertex twice: maps are cut there",
    ),
    (
        "LEFT_OUT",
        "Left Out",
        "Coordinates that are not finite or far away from all others, faces of fewer than three vertices, parts "
        "without area: maps leave them out",
    ),
    ("NO_AREA", "No Area", "Faces with a triangle without area"),
    ("TOUCHING", "Touching", "Vertices where faces touch without a common edge; maps are cut there too"),
    ("LOOSE", "Loose", "Vertices without a face; they are harmless"),
    ("FLIPPED", "Flipped UVs", "Faces that the active UV map flips or collapses"),
)

REPAIRS = (
    ("WELD", "Weld", "Vertices closer together than the distance"),
    ("DOUBLES", "Doubles", "Faces with the same vertices as another face"),
    ("INSIDE", "Inside Faces", "Faces all of whose edges have more than two faces"),
    ("SLIVERS", "Slivers", "Faces without area, merged with the face at their longest side"),
    ("LOOSE", "Loose", "Vertices and edges without a face"),
)


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
    the binary logarithm of UV area per surface area over its median, and "Holomorphic Angle", s1 / s2"""

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


class HOLOMORPH_OT_select_bad(AtOnce, bpy.types.Operator):
    """Go to edit mode and select elements of the selected meshes at which maps are cut, which maps leave out, or
    which spoil maps"""

    bl_idname = "mesh.holomorphic_select_bad"
    bl_label = "Select Bad Elements"
    nothing = "There are no bad elements"

    kinds: EnumProperty(
        name="Elements",
        description="Kind of elements to select",
        items=KINDS,
        options={"ENUM_FLAG"},
        default={"CUT", "LEFT_OUT", "NO_AREA"},
    )

    def draw(self, _context):
        self.layout.column().prop(self, "kinds")

    def read(self, context, objects):
        self._is_editing = context.mode == "EDIT_MESH"
        return objects

    def act(self, step, objects):
        from ..results import bad
        from ..scene import targets

        context = step.context
        found = {target.find(): self._elements(target) for target in targets.collect(objects)}
        if not any(found.values()):
            return False
        for obj, elements in found.items():
            if elements is not None:
                bad.select(obj.data, elements)
        context.scene.tool_settings.mesh_select_mode = bad.select_mode([e for e in found.values() if e])
        if not self._is_editing:
            edit(context, [obj for obj, elements in found.items() if elements])
        return True

    def _elements(self, target):
        """The `bad.Elements` of a target; None for one that is refused."""
        from ..results import bad, heat

        if target.refused:
            self.report({"WARNING"}, f"{target.name}: {target.refused}")
            return None
        mesh = target.find().data
        uv = heat.active_map(mesh, target.polygons) if mesh.uv_layers.active else None
        elements = bad.find(target.polygons, uv, self.kinds)
        if elements:
            self.report({"INFO"}, f"{target.name}: {elements}")
        return elements


def edit(context, objects):
    """Edit mode for these objects alone, the active one among them."""
    from .. import compatibility

    for obj in compatibility.selected_in(context.view_layer):
        obj.select_set(obj in objects)
    if context.view_layer.objects.active not in objects:
        context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")


class HOLOMORPH_OT_repair(AtOnce, bpy.types.Operator):
    """Weld vertices of the selected meshes, remove duplicate faces, inside faces and loose elements, and merge faces
    without area, so that maps need no cuts there. What remains keeps its UV maps, attributes, shape keys and
    materials"""

    bl_idname = "mesh.holomorphic_repair"
    bl_label = "Repair Mesh for Maps"
    needs_library, nothing = False, "There is nothing to repair"

    kinds: EnumProperty(
        name="Repairs",
        description="Repairs to make",
        items=REPAIRS,
        options={"ENUM_FLAG"},
        default={"WELD", "DOUBLES", "INSIDE", "SLIVERS", "LOOSE"},
    )
    distance: FloatProperty(
        name="Distance",
        description="Weld vertices that are closer together than this",
        default=1e-4,
        min=0,
        soft_max=0.1,
        precision=5,
        subtype="DISTANCE",
    )

    def draw(self, _context):
        self.layout.column().prop(self, "kinds")
        self.layout.prop(self, "distance")

    def act(self, _step, objects):
        from ..results import repair

        done = []
        for obj in {obj.data: obj for obj in reversed(objects)}.values():
            if len(obj.data.polygons):
                repaired = repair.repair(obj.data, self.kinds, self.distance)
                done += [f"{obj.name}: {repaired}"] * bool(repaired)
        if done:
            self.report({"INFO"}, "; ".join(done))
        return bool(done)


register, unregister = bpy.utils.register_classes_factory(
    [
        HOLOMORPH_OT_restore_materials,
        HOLOMORPH_OT_heat,
        HOLOMORPH_OT_remove_maps,
        HOLOMORPH_OT_select_bad,
        HOLOMORPH_OT_repair,
    ]
)
