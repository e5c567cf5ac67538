# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that select and repair elements of meshes for which maps are bad."""

import math

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


class HOLOMORPH_OT_select_stretched(AtOnce, bpy.types.Operator):
    """Go to edit mode and select the faces on which the active UV map of the selected meshes makes a texture too large,
    too small or sheared"""

    bl_idname = "mesh.holomorphic_select_stretched"
    bl_label = "Select Stretched Faces"
    nothing = "No face is stretched that much"

    size: FloatProperty(
        name="Size",
        description="Faces whose squares are longer or shorter than the median by this factor",
        default=2.0,
        min=1.0,
        soft_max=10.0,
    )
    angle: FloatProperty(
        name="Angle Distortion",
        description="Faces whose squares are longer than wide by this factor",
        default=2.0,
        min=1.0,
        soft_max=10.0,
    )

    def draw(self, _context):
        self.layout.prop(self, "size")
        self.layout.prop(self, "angle")

    def read(self, context, objects):
        self._is_editing = context.mode == "EDIT_MESH"
        return objects

    def act(self, step, objects):
        from ..results import bad, heat

        found = {obj: self._elements(obj) for obj in objects if heat.is_possible(obj)}
        if not any(found.values()):
            return False
        for obj, elements in found.items():
            bad.select(obj.data, elements)
        step.context.scene.tool_settings.mesh_select_mode = bad.select_mode([e for e in found.values() if e])
        if not self._is_editing:
            edit(step.context, [obj for obj, elements in found.items() if elements])
        return True

    def _elements(self, obj):
        """The stretched faces as `bad.Elements`."""
        from ..results import bad, heat

        _, distortion = heat.measured(obj.data, obj.matrix_world.to_3x3())
        elements = bad.stretched(distortion, 2 * math.log2(self.size), self.angle)
        if elements:
            self.report({"INFO"}, f"{obj.name}: {elements}")
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
    [HOLOMORPH_OT_select_bad, HOLOMORPH_OT_select_stretched, HOLOMORPH_OT_repair]
)
