# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: one computes the maps, one measures a map, one brings the object's own materials back."""

import math

import bpy
from bpy.props import EnumProperty, FloatProperty

from .. import native
from .availability import Explained, OnMeshes
from .modal import MODAL_FACES, MODAL_TILED_FACES, WorkOperator
from .properties import HARD_EDGE, HARD_EDGES, MAIN_MAPS, MOST_STRETCH, MapProperties


class _MapsOperator(MapProperties, OnMeshes, WorkOperator):
    """What the operators that make maps share."""

    def prepare(self, context):
        from ..scene import faces, targets

        try:
            request = self.request()
            self._targets = targets.collect(targets.mesh_objects(context), request)
        except ValueError as error:
            self.report({"ERROR"}, f"Residues: {error}")
            return False
        except faces.NoFaces as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def make_work(self, progress):
        from ..maps import seamless
        from ..scene import targets
        from ..solving import jobs

        tasks = targets.tasks(self._targets)
        self._mapper = seamless.Mapper(self.map_options(), self.equal)
        return jobs.Job(tasks, progress, [self._mapper] * len(tasks))

    def waiting_faces(self):
        from ..scene import targets
        from ..solving import cache

        tasks = targets.tasks(self._targets)
        waiting = [task.polygons for task in tasks if self.main != "BALANCED" or cache.find(task) is None]
        return sum(p.face_count for p in waiting)

    def modal_faces(self):
        return MODAL_FACES if self.main == "BALANCED" else MODAL_TILED_FACES

    def finish(self, context, work, time_has_passed):
        from ..results import run
        from ..scene import targets

        results = targets.align(self._targets, work.results)
        options = self._mapper.options(results), self.write_options()
        outcome = run.write(context, self._targets, results, *options, time_has_passed)
        self.form_count = outcome.forms
        self.show(context, outcome, self.checker)
        return self.tell(outcome)


class HOLOMORPH_OT_maps(_MapsOperator, bpy.types.Operator):
    """Compute conformal UV maps for the selected meshes, whatever their shape; in edit mode for the selected faces.
    Maps named "Holomorphic" of an earlier run are replaced, other maps are kept"""

    bl_idname = "uv.holomorphic_maps"
    bl_label = "Holomorphic UV Maps"
    bl_options = {"REGISTER", "UNDO", "PRESET"}


class HOLOMORPH_OT_islands(_MapsOperator, bpy.types.Operator):
    """Cut the selected meshes along their hard edges and seams, and flatten each island without shearing: for meshes of
    few or long thin faces, which no seamless map can fit"""

    bl_idname = "uv.holomorphic_islands"
    bl_label = "Islands by Hard Edges"
    bl_options = {"REGISTER", "UNDO"}

    # Of its own, so that the maps operator does not remember them.
    main: EnumProperty(name="Main Map", description="What the main map is", items=MAIN_MAPS, default="ISLANDS")
    hard_edges: FloatProperty(
        name="Hard Edges", description=HARD_EDGES, default=HARD_EDGE, min=0.0, max=math.pi, subtype="ANGLE"
    )
    most_stretch: FloatProperty(name="Most Stretch", description=MOST_STRETCH, min=0.0, soft_max=10.0)


class HOLOMORPH_OT_restore_materials(bpy.types.Operator):
    """Bring back what was shown before: the materials that the checker or a texture covers, on all objects with the
    same mesh, the UV maps that were active in the editors and for renders, and the shading of the 3D views"""

    bl_idname = "uv.holomorphic_restore_materials"
    bl_label = "Restore Materials"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode in {"OBJECT", "EDIT_MESH"}

    def execute(self, context):
        from ..materials import viewport
        from ..results import restore
        from ..scene import targets

        own = [obj for obj in targets.mesh_objects(context) if obj.data.library is None]
        restored = [restore.restore(obj) for obj in own]
        viewport.restore_without_textures(context)
        return {"FINISHED"} if any(restored) else {"CANCELLED"}


class HOLOMORPH_OT_heat(Explained, bpy.types.Operator):
    """Write how the active UV map distorts, as attributes of the faces of the selected meshes: "Holomorphic Density",
    the binary logarithm of UV area per surface area over its median, and "Holomorphic Angle", s1 / s2"""

    bl_idname = "uv.holomorphic_heat"
    bl_label = "Holomorphic Heat Maps"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def why_not(cls, context):
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            return "Go to Object Mode or Edit Mode"
        selected = context.view_layer.objects.selected
        return "" if any(o.type == "MESH" and o.data.uv_layers for o in selected) else "Select a mesh with a UV map"

    def execute(self, context):
        from ..results import heat, run
        from ..scene import targets

        with run.object_mode(context):
            objects = [o for o in targets.mesh_objects(context) if heat.is_possible(o)]
            for obj in objects:
                found = heat.write(obj)
                name = obj.data.uv_layers.active.name
                density, angle = f"95 : 5 % of density {found.density_text}", f"mean angle {found.mean_angle:.4f}"
                self.report({"INFO"}, f"{obj.name}, {name}: {density}, {angle}")
        return {"FINISHED"} if objects else {"CANCELLED"}


@bpy.app.handlers.persistent
def _forget_solves(*_arguments):
    """Another file has other meshes; what was kept for the old one would only take memory."""
    if native.problem():
        return
    from ..solving import cache

    cache.clear()


CLASSES = (HOLOMORPH_OT_maps, HOLOMORPH_OT_islands, HOLOMORPH_OT_heat, HOLOMORPH_OT_restore_materials)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.app.handlers.load_pre.append(_forget_solves)


def unregister():
    bpy.app.handlers.load_pre.remove(_forget_solves)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    _forget_solves()
