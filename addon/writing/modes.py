# SPDX-License-Identifier: GPL-3.0-or-later
"""The modes in which meshes are edited, sculpted or painted: left while they are written, and entered again."""

import bpy

from .. import compatibility


class Modes:
    """The modes of the mesh objects of a view layer, whichever of them is the active one."""

    def __init__(self, context):
        layer = context.view_layer
        self._layer, self._selected = layer, set(compatibility.selected_in(layer))
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
                self._select(self._selected)
            for obj in objects:
                if obj.mode != mode:
                    self._set(obj, mode)

    def _set(self, obj, mode):
        active, self._layer.objects.active = self._layer.objects.active, obj
        bpy.ops.object.mode_set(mode=mode)
        self._layer.objects.active = active

    def _select(self, objects):
        for obj in {*self._selected, *self._before["EDIT"]}:
            obj.select_set(obj in objects)


def _elsewhere(layer):
    """The mesh objects that are not in object mode."""
    return [obj for obj in compatibility.objects_in(layer) if obj.type == "MESH" and obj.mode != "OBJECT"]
