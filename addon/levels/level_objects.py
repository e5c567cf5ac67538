# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail as objects: copies of an object with the meshes of the levels, in a collection of their own. The
object is read when the work begins."""

from dataclasses import dataclass

import bpy

from .. import compatibility, native
from ..results import report, tags
from ..results.write import WriteOptions
from ..results.write import write as write_maps
from ..scene import mesh_io, stored_dials, targets, uv_maps
from ..writing import transaction, transferred
from . import transfer
from .levels import LevelsWork

OF = "holomorph_levels_of"  # custom property of levels and their collection: name of the object they are levels of
FINEST = "_LOD0"  # end of the name of the finest level: engines know levels by such names
GAP = 1.2  # distance of levels side by side, in widths of the object


@dataclass(frozen=True)
class Presentation:
    """How levels come into the scene."""

    side_by_side: bool = False  # in a row along X, not in the object's place
    hidden: bool = False  # in the view layer and for renders


def write(step, obj, data, work, presentation=Presentation()):
    """Replaces the levels of an earlier run; `data` is the object's `transfer.MeshData`, `work` a `LevelsWork`."""
    step.remove(tags.find(OF, obj))
    context = step.context
    collection, name = _collection(context, obj), obj.name.removesuffix(FINEST)
    levels = [
        _level_object(obj, data, level, work.names, f"{name}_LOD{number}")
        for number, level in enumerate(work.levels, 1)
    ]
    # A copy of the object is level 0; one that is called so is it itself.
    copies = [_copy(obj, obj.data.copy(), name + FINEST)] if name == obj.name else []
    made = copies + levels
    for level_object in made:
        collection.objects.link(level_object)
    context.view_layer.update()
    apart = GAP * _width(obj) if presentation.side_by_side else 0.0
    for index, level_object in enumerate(made, 1):
        matrix = obj.matrix_world.copy()
        matrix.translation.x += index * apart
        level_object.matrix_world = matrix
    transferred.weights(context, obj, levels, "NEAREST")  # vertices have not moved
    _put_away(context, made, presentation.hidden)
    return made


def _put_away(context, made, hidden):
    shown = compatibility.objects_in(context.view_layer)
    for level_object in made:
        level_object.hide_render = hidden
        if level_object in shown:
            level_object.select_set(False)  # the next operator is meant for the object alone
            level_object.hide_set(hidden)


def _level_object(obj, data, level, names, name):
    """A copy of the object, with its materials, modifiers and parent, but with the mesh of the level."""
    positions = data.positions[level.surface.vertex_index]
    mesh = mesh_io.new_mesh(name, positions, level.surface.corner_vertices, level.surface.face_offsets)
    for material in obj.data.materials:
        mesh.materials.append(material)
    transfer.write(mesh, data, level, names)
    compatibility.copy_auto_smooth(obj.data, mesh)
    return _copy(obj, mesh, name)


def _copy(obj, mesh, name):
    copy = obj.copy()
    copy.data = mesh
    copy.name = mesh.name = name
    report.remove(copy)
    tags.put(copy, OF, obj)
    return copy


def _collection(context, obj):
    """The collection of the levels: a child of a visible, editable collection of the object, else of the scene's."""
    shown = _shown_collections(context.view_layer.layer_collection)
    parent = next((c for c in shown if obj.name in c.objects and c.library is None), context.scene.collection)
    for collection in tags.find(OF, obj, parent.children):
        return collection
    collection = bpy.data.collections.new(f"{obj.name} LODs")
    tags.put(collection, OF, obj)
    parent.children.link(collection)
    return collection


def _shown_collections(layer):
    """The collections of a layer and its children, without those that are excluded from the view layer."""
    if not layer.exclude:
        yield layer.collection
        for child in layer.children:
            yield from _shown_collections(child)


def _width(obj):
    """Size along X in world space."""
    points = mesh_io.world_points(obj)
    return float(points[:, 0].max() - points[:, 0].min())


class Source:
    """The object as it was when the work began."""

    def __init__(self, obj):
        (self.target,) = targets.collect([obj])
        self.refused = self.target.refused
        self._data = None if self.refused else transfer.read(obj.data, self.target.polygons)
        made = stored_dials.made(obj)
        self._main, self._turns = uv_maps.main_map(obj.data), made.turns if made else 1

    def work(self, options, progress=None):
        """The `LevelsWork`."""
        (task,) = targets.tasks([self.target])
        needs_map = not set(self._data.own_maps) & set(self._data.maps)
        turns = [self._turns if name == self._main else 1 for name in self._data.maps]
        return LevelsWork(task, self._data.maps, self._data.uv, turns, needs_map, options, progress)

    def write(self, step, work, presentation, time_has_passed=False):
        """(objects of the levels, sentences about the map that they needed), or the one sentence why there are none.

        step : the `transaction.Step` of the object
        """
        problem = self.problem(work, time_has_passed)
        if problem:
            return [], [problem]
        told = []
        if work.mapped is not None:
            outcome = write_maps(step, [self.target], [work.mapped], WriteOptions(checker=False))
            told = outcome.problems + outcome.notes
        return write(step, self.target.find(), self._data, work, presentation), told

    def problem(self, work, time_has_passed):
        if work.error is not None:
            return native.sentence(work.error)
        if self.target.has_changed(time_has_passed):
            return "it changed while its levels were made; please run it again"
        if not work.names:
            reasons = {part.skipped for part in work.mapped.parts}
            return f"there is no UV map, and none could be made: {'; '.join(sorted(reasons))}"
        return "" if work.levels else "it cannot be made coarser"


def make(context, obj, options, presentation):
    """What `Source.write` gives, here and now."""
    source = Source(obj)
    if source.refused:
        return [], [source.refused]
    work = source.work(options)
    work.run()
    with transaction.one_step(context, [obj]) as step:
        return source.write(step, work, presentation)
