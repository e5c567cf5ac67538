# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes levels of detail of the active object, with UV maps that stay in place."""

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty

from . import native
from .modal import WorkOperator

OF = "holomorph_levels_of"  # custom property of levels and their collection: name of the object they are levels of
GAP = 1.2  # distance of levels side by side, in widths of the object


class HOLOMORPH_OT_levels(WorkOperator, bpy.types.Operator):
    """Make coarser copies of the active object, of triangles, on which every texture stays in place: UV maps have the
    same values at the same vertices and the same seams. Where there is no map "Holomorphic" it is made first.
    Levels of an earlier run are replaced"""

    bl_idname = "object.holomorphic_levels"
    bl_label = "Holomorphic Levels of Detail"
    bl_options = {"REGISTER", "UNDO"}

    levels: IntProperty(name="Levels", description="How many levels are made", default=4, min=1, max=12)
    ratio: FloatProperty(
        name="Ratio",
        description="Triangles of each level over those of the one before",
        default=0.25,
        min=0.01,
        max=0.95,
    )
    coarsest: IntProperty(
        name="Coarsest",
        description="Triangles of the last level; 0 lets the ratio decide. A surface with handles needs some, and is "
        "never made coarser than that",
        default=0,
        min=0,
    )
    side_by_side: BoolProperty(
        name="Side by Side",
        description="Put the levels beside the object, in a row along X, instead of into its place",
        default=False,
    )

    @classmethod
    def poll(cls, context):
        if native.problem():
            cls.poll_message_set(native.problem())
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Go to Object Mode")
            return False
        obj = context.view_layer.objects.active
        if obj is None or obj.type != "MESH":
            cls.poll_message_set("Make a mesh object active")
            return False
        return True

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "levels")
        row = layout.row()
        row.active = self.coarsest == 0
        row.prop(self, "ratio")
        layout.prop(self, "coarsest")
        layout.prop(self, "side_by_side")

    def prepare(self, context):
        self._source = Source(context.view_layer.objects.active)
        if self._source.target.refused:
            self.report({"ERROR"}, f"{self._source.target.name}: {self._source.target.refused}")
        return not self._source.target.refused

    def make_work(self, progress):
        from . import levels

        return self._source.work(levels.LevelOptions(self.levels, self.ratio, self.coarsest), progress)

    def waiting_faces(self):
        return len(self._source.target.polygons.face_offsets) - 1

    def finish(self, context, work, time_has_passed):
        source, name = self._source, self._source.target.name
        problem = source.problem(work, time_has_passed)
        if problem:
            self.report({"ERROR"}, f"{name}: {problem}")
            return {"CANCELLED"}
        notes = source.write_map(context, work)
        made = source.write_levels(context, work, self.side_by_side)
        for sentence in notes:
            self.report({"WARNING"}, sentence)
        counts = ", ".join(str(len(level.surface.triangles)) for level in work.levels)
        kept = f"; {name} allows no coarser one" if len(made) < self.levels else ""
        self.report({"INFO"}, f"{name}: levels of {counts} triangles{kept}")
        return {"FINISHED"}


def make_levels(context, obj, options, side_by_side=False):
    """Here and now: the objects of the levels, and one sentence where there are none."""
    source = Source(obj)
    if source.target.refused:
        return [], source.target.refused
    work = source.work(options)
    work.run()
    problem = source.problem(work)
    if problem:
        return [], problem
    source.write_map(context, work)
    return source.write_levels(context, work, side_by_side), ""


class Source:
    """The object whose levels are made, as it was when the operator began."""

    def __init__(self, obj):
        from . import carried, run

        (self.target,) = run.collect([obj])
        self.carried = None if self.target.refused else carried.read(obj.data, self.target.polygons)

    def work(self, options, progress=None):
        from . import levels, mesh_io, run

        (task,) = run.tasks([self.target])
        needs_map = mesh_io.MAIN_MAP not in self.carried.maps
        return levels.LevelsWork(task, self.carried.maps, self.carried.uv, needs_map, options, progress)

    def problem(self, work, time_has_passed=False):
        """Why nothing is written, one sentence, or nothing."""
        from . import run

        obj = self.target.find()
        if work.error is not None:
            return " ".join(str(work.error).split())
        if obj is None or (time_has_passed and not run.read(obj).equals(self.target.polygons)):
            return "it was changed while its levels were made; please run it again"
        if not work.names:
            reasons = {" ".join(c.reason.split()) for c in work.solved.components}
            return f"there is no UV map, and none could be made: {'; '.join(sorted(reasons))}"
        if not work.levels:
            return "it has no coarser level"
        return ""

    def write_map(self, context, work):
        """Writes the map that was made to the object itself; sentences about what was not done."""
        from . import maps, run

        if work.solved is None:
            return []
        outcome = run.write(
            context, [self.target], [work.solved], maps.MapOptions(forms=0), run.WriteOptions(checker=False)
        )
        return outcome.problems + outcome.notes

    def write_levels(self, context, work, side_by_side=False):
        """The levels as objects, in a collection of their own."""
        obj = self.target.find()
        _remove_levels(obj.name)
        collection = _collection(context, obj)
        step = GAP * _width(obj) if side_by_side else 0.0
        made = []
        for index, level in enumerate(work.levels, 1):
            level_object = self._level_object(obj, level, work.names, f"{obj.name}_LOD{index}")
            collection.objects.link(level_object)
            made.append(level_object)
        context.view_layer.update()
        for index, level_object in enumerate(made, 1):
            if level_object.name in context.view_layer.objects:
                level_object.select_set(False)  # what is pressed next is meant for the object alone
            matrix = obj.matrix_world.copy()
            matrix.translation.x += index * step
            level_object.matrix_world = matrix
        _carry_vertex_groups(context, obj, made)
        return made

    def _level_object(self, obj, level, names, name):
        """A copy of the object, with its materials, modifiers and parent, but with the mesh of the level."""
        from . import carried, compatibility, mesh_io, report

        positions = self.carried.positions[level.surface.vertex_index]
        mesh = mesh_io.new_mesh(name, positions, level.surface.corner_vertices, level.surface.face_offsets)
        for material in obj.data.materials:
            mesh.materials.append(material)
        carried.write(mesh, self.carried, level, names)
        compatibility.copy_auto_smooth(obj.data, mesh)
        copy = obj.copy()
        copy.data = mesh
        copy.name = name
        copy.pop(report.PROPERTY, None)
        copy[OF] = obj.name
        return copy


def _remove_levels(name):
    """Removes the levels of an earlier run."""
    for level in [o for o in bpy.data.objects if o.library is None and o.get(OF) == name and o.name != name]:
        mesh = level.data
        bpy.data.objects.remove(level)
        if mesh is not None and mesh.users == 0:
            bpy.data.meshes.remove(mesh)


def _collection(context, obj):
    """The collection of the levels, beside the object where that is shown and may be changed."""
    shown = _shown_collections(context.view_layer.layer_collection)
    beside = next((c for c in shown if obj.name in c.objects and c.library is None), context.scene.collection)
    for collection in beside.children:
        if collection.get(OF) == obj.name:
            return collection
    collection = bpy.data.collections.new(f"{obj.name} LODs")
    collection[OF] = obj.name
    beside.children.link(collection)
    return collection


def _shown_collections(layer):
    """That of a layer and those below it, without the ones that are excluded from the view layer."""
    if not layer.exclude:
        yield layer.collection
        for child in layer.children:
            yield from _shown_collections(child)


def _width(obj):
    """Along X in the world."""
    from . import mesh_io

    points = mesh_io.world_points(obj)
    return float(points[:, 0].max() - points[:, 0].min())


def _carry_vertex_groups(context, obj, made):
    """Weights by Blender's own transfer, from a bare object of the same mesh: vertices of levels have not moved, and
    the nearest vertex is the same one."""
    if not obj.vertex_groups:
        return
    bare = bpy.data.objects.new("Holomorph Weights", obj.data)
    bare.matrix_world = obj.matrix_world
    context.scene.collection.objects.link(bare)
    context.view_layer.update()
    objects = {"selected_objects": [bare, *made], "selected_editable_objects": [bare, *made]}
    try:
        with context.temp_override(object=bare, active_object=bare, **objects):
            bpy.ops.object.data_transfer(
                data_type="VGROUP_WEIGHTS",
                use_create=True,
                vert_mapping="NEAREST",
                use_object_transform=False,
                layers_select_src="ALL",
                layers_select_dst="NAME",
            )
    finally:
        bpy.data.objects.remove(bare)


def register():
    bpy.utils.register_class(HOLOMORPH_OT_levels)


def unregister():
    bpy.utils.unregister_class(HOLOMORPH_OT_levels)
