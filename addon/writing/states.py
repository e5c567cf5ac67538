# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, materials, 3D views and the report's text as they were, to be put back."""

import bpy

from ..materials import material

OURS = "holomorph"  # what the names of our custom properties begin with
NAMED = "Holomorphic"  # and those of our texts


def own_properties(owner):
    """Our custom properties of a data-block."""
    values = {name: owner[name] for name in owner.keys() if name.startswith(OURS)}  # noqa: SIM118  no dictionary
    return {name: dict(value) if hasattr(value, "keys") else value for name, value in values.items()}


def restore_properties(owner, before):
    now = own_properties(owner)
    for name in now.keys() - before.keys():
        del owner[name]
    for name, value in before.items():
        if now.get(name) != value:
            owner[name] = value


class Properties:
    """Our custom properties of a data-block."""

    def __init__(self, owner):
        self._owner, self._before = owner, own_properties(owner)

    def restore(self):
        restore_properties(self._owner, self._before)


class ObjectState:
    """An object's material slots, properties, and whether it is rendered. @pre for `restore`: its mesh is restored"""

    def __init__(self, obj):
        self._object, self._properties = obj, Properties(obj)
        self._links, self._own = [slot.link for slot in obj.material_slots], []
        self._active, self._hidden = obj.active_material_index, obj.hide_render

    def read_own_materials(self):
        """Reads the materials that the slots have on the object. Blender tells them only of slots with this link, so
        that reading writes the links: call `restore` if it fails."""
        for slot, link in zip(self._object.material_slots, self._links):
            slot.link = "OBJECT"
            self._own.append(slot.material)
            slot.link = link

    def restore(self):
        obj = self._object
        for index, (slot, link) in enumerate(zip(obj.material_slots, self._links)):
            if index < len(self._own):
                slot.link = "OBJECT"
                slot.material = self._own[index]
            slot.link = link
        obj.active_material_index, obj.hide_render = self._active, self._hidden
        self._properties.restore()


class Attributes:
    """Some attributes of one of Blender's structs."""

    def __init__(self, owner, *names):
        self._owner, self._before = owner, {name: _plain(getattr(owner, name)) for name in names}

    def restore(self):
        for name, value in self._before.items():
            if _plain(getattr(self._owner, name)) != value:
                setattr(self._owner, name, value)


def _plain(value):
    """A copy of Blender's arrays, which change with what they belong to."""
    return tuple(value) if isinstance(value, bpy.types.bpy_prop_array) else value


def materials():
    """What is adjusted in the node trees of our materials: numbers and images."""
    ours = [m for m in bpy.data.materials if material.OURS in m and m.library is None and m.node_tree is not None]
    for node in (node for own in ours for node in own.node_tree.nodes):
        if hasattr(node, "image"):
            yield Attributes(node, "image")
        for socket in (*node.inputs, *node.outputs):
            if isinstance(getattr(socket, "default_value", None), float):
                yield Attributes(socket, "default_value")


def views(window):
    """The shading of a window's 3D views."""
    if window is not None:
        yield Properties(window.screen)
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                yield Attributes(area.spaces.active.shading, "type", "color_type")


class TextState:
    """A text as it was."""

    def __init__(self, text):
        self._text, self._before = text, text.as_string()

    def restore(self):
        if self._text.as_string() != self._before:
            self._text.from_string(self._before)


def texts():
    """Our reports."""
    for text in bpy.data.texts:
        if text.name.startswith(NAMED) and text.library is None:
            yield TextState(text)
