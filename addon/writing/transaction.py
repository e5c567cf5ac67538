# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing in one step: all that an operator writes is done, or Blender's data are put back as they were."""

from contextlib import ExitStack, contextmanager

import bpy

from .. import compatibility
from . import states

MADE = (
    "objects",
    "meshes",
    "materials",
    "images",
    "texts",
    "collections",
    "node_groups",
)  # kinds of data-blocks that are made here
REMOVED = "Holomorph Removed"  # name of what is about to be removed
PUT_BACK = "Nothing was changed: all writes were undone"


@contextmanager
def one_step(context, objects):
    """Does all that is written within, or puts everything back and raises the error again.

    Gives the `Step`, which takes objects that are to be removed. Objects are in object mode meanwhile, since Blender
    gives no UV layers in edit mode, and other modes keep copies of the mesh.

    objects : whose meshes, materials and properties are going to be changed; those that share their meshes count too
    """
    before, step = _Before(context), Step(context)
    before.modes.push_undo()
    try:
        before.modes.leave()
        before.read(objects, step)
        yield step
        before.modes.enter()
        step.finish()
    except BaseException as error:
        if not step.is_finished():
            before.restore(step)
            error.add_note(PUT_BACK)
        raise


@contextmanager
def naming(target):
    """Adds to an error raised within that this `targets.Target` was being written."""
    try:
        yield
    except BaseException as error:
        error.add_note(f"This happened while {target.name} was written.")
        raise


class Step:
    """Removes objects at its end, in one call, since Blender cannot bring them back."""

    def __init__(self, context):
        self.context = context
        self._objects, self._names, self._copies = [], {}, []

    def remove(self, objects):
        """Removes these objects at the end, and data that nothing else uses. Their names are free at once."""
        self._objects += [obj for obj in objects if obj not in self._objects]
        used = [obj.data for obj in self._objects if obj.data is not None]
        self.discard(self._objects + [data for data in used if data.users == used.count(data)])

    def discard(self, blocks):
        """Removes these data-blocks, whatever uses them, at the end. Their names are free at once."""
        for block in blocks:
            if block not in self._names:
                self._names[block] = block.name
                block.name = REMOVED

    def keep(self, copies):
        """Removes these data-blocks at the end; until then they keep their names."""
        self._copies += copies

    def finish(self):
        if self._names or self._copies:
            remove([*self._names, *self._copies])

    def is_finished(self):
        try:
            return any(not block.name for block in (*self._names, *self._copies))
        except ReferenceError:  # a data-block that is gone
            return True

    def restore(self):
        for block, name in self._names.items():
            block.name = name


class _Before:
    """The open file when a step begins, as far as it is going to be changed."""

    def __init__(self, context):
        layer = context.view_layer
        self._context = context
        self.modes, self._active = Modes(context), layer.objects.active
        self._hidden = {obj for obj in compatibility.objects_in(layer) if obj.hide_get()}
        self._blocks = {block.as_pointer() for block in _blocks()}
        self._kept = [states.Attributes(context.scene.tool_settings, "mesh_select_mode", "use_uv_select_sync")]

    def read(self, objects, step):
        """Notes the state of the objects. @pre their modes are left"""
        meshes = {obj.data for obj in objects if obj.data.library is None}
        users = [obj for obj in bpy.data.objects if obj.data in meshes and obj.library is None]
        self._kept += [*states.texts(), *states.materials(), *states.views(self._context.window)]
        of_objects = [states.ObjectState(obj) for obj in users]
        of_meshes = [states.MeshState(mesh) for mesh in meshes]
        step.keep([state.copy for state in of_meshes])
        self._kept += of_objects + of_meshes
        for state in of_objects:
            state.read_own_materials()

    def restore(self, step):
        """Puts everything back, and goes on where a part of that fails."""
        with ExitStack() as last_first:
            last_first.callback(self._restore_view)
            last_first.callback(step.restore)  # when new objects have given the names back
            last_first.callback(self._remove_new)
            for state in self._kept:
                last_first.callback(state.restore)
            last_first.callback(self.modes.leave)

    def _restore_view(self):
        layer = self._context.view_layer
        for obj in compatibility.objects_in(layer):
            obj.hide_set(obj in self._hidden)
            obj.select_set(obj in self.modes.selected)
        layer.objects.active = self._active
        self.modes.enter()

    def _remove_new(self):
        new = [block for block in _blocks() if block.as_pointer() not in self._blocks]
        if new:
            remove(new)


def remove(blocks):
    """Removes data-blocks in one call, with their shape keys: Blender 3.4 would keep these, with a dangling pointer."""
    keys = [block.shape_keys for block in blocks if getattr(block, "shape_keys", None) is not None]
    bpy.data.batch_remove([*blocks, *keys])


def _blocks():
    return [block for kind in MADE for block in getattr(bpy.data, kind)]


class Modes:
    """The modes of the mesh objects of a view layer, whichever of them is the active one; `selected` are those that
    were selected."""

    def __init__(self, context):
        layer = context.view_layer
        self._layer, self.selected = layer, set(compatibility.selected_in(layer))
        self._before = {}  # mode: its objects
        for obj in _elsewhere(layer):
            self._before.setdefault(obj.mode, []).append(obj)

    def push_undo(self):
        """Pushes an undo step where something is sculpted or painted: else Blender would undo what follows together
        with the last stroke.
        """
        if self._before.keys() - {"EDIT"}:
            bpy.ops.ed.undo_push(message="Before Holomorph")

    def leave(self):
        """Puts all objects in object mode, also those that have entered another mode since."""
        for obj in _elsewhere(self._layer):
            if obj.mode != "OBJECT":  # edit mode is left by all objects at once
                self._set(obj, "OBJECT")

    def enter(self):
        """Puts the objects that are in object mode now back in their earlier modes."""
        for mode, objects in self._before.items():
            objects = [obj for obj in objects if obj.mode == "OBJECT"]
            if mode == "EDIT" and objects:  # all objects at once, which have to be selected for it
                self._select(objects)
                active = self._layer.objects.active
                self._set(active if active in objects else objects[0], mode)
                self._select(self.selected)
            for obj in objects:
                if obj.mode != mode:
                    self._set(obj, mode)

    def _set(self, obj, mode):
        active, self._layer.objects.active = self._layer.objects.active, obj
        bpy.ops.object.mode_set(mode=mode)
        self._layer.objects.active = active

    def _select(self, objects):
        for obj in {*self.selected, *self._before["EDIT"]}:
            obj.select_set(obj in objects)


def _elsewhere(layer):
    """The mesh objects that are not in object mode."""
    return [obj for obj in compatibility.objects_in(layer) if obj.type == "MESH" and obj.mode != "OBJECT"]
