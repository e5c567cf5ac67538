# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, materials, 3D views and the report's text as they were, to be put back."""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..materials import material
from ..scene import mesh_io, stored_dials

OURS = "holomorph"  # what the names of our custom properties begin with
NAMED = "Holomorphic"  # and those of our texts


def own_properties(owner):
    """Our custom properties of a data-block."""
    names = [name for name in owner.keys() if name.startswith(OURS) and name != stored_dials.NAME]  # noqa: SIM118
    values = {name: owner[name] for name in names}
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


class DialsState:
    """The dials of an object, and what is known of its map."""

    def __init__(self, obj):
        self._object, self._before, self._known = obj, stored_dials.chosen(obj), stored_dials.known(obj)

    def restore(self):
        stored_dials.choose(self._object, self._before)
        stored_dials.know(self._object, *self._known)


class ObjectState:
    """An object's material slots, properties, dials, and whether it is rendered. @pre for `restore`: its mesh is
    restored"""

    def __init__(self, obj):
        self._object, self._properties, self._dials = obj, Properties(obj), DialsState(obj)
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
        self._dials.restore()


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
    """What is adjusted of our materials: properties, and numbers and images in the node trees."""
    ours = [m for m in bpy.data.materials if material.OURS in m and m.library is None and m.node_tree is not None]
    yield from map(Properties, ours)
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


UV_MAP = "UV_MAP"  # kind of the layers that are not attributes: UV maps before Blender 3.5
UV_VALUES = ("uv", np.float32, 2), ("pin_uv", bool), ("select", bool), ("select_edge", bool)
FIXED = {"position", ".edge_verts", ".corner_vert", ".corner_edge"}  # Blender removes none of these
KINDS = compatibility.ATTRIBUTES | {
    "QUATERNION": ("value", np.float32, 4),
    "FLOAT4X4": ("value", np.float32, 16),
    "INT32_2D": ("value", np.int32, 2),
    "INT16_2D": ("value", np.int32, 2),
}
USES = ("active_clone", "active_render", "active")  # of UV maps
COLOURS = ("active_color_name", "default_color_name")


class Layer(NamedTuple):
    """A UV map or an attribute of a mesh."""

    name: str
    domain: str
    kind: str

    def read(self, mesh):
        return [mesh_io.read_values(values) for values in self._values(mesh)]

    def write(self, mesh, arrays):
        for values, array in zip(self._values(mesh), arrays):
            mesh_io.write_values(values, array)

    def add_to(self, mesh):
        if self.kind == UV_MAP:
            mesh.uv_layers.new(name=self.name, do_init=False)
        else:
            mesh.attributes.new(self.name, self.kind, self.domain)

    def remove_from(self, mesh):
        """Removes the layer; with a UV map go the attributes that are its selections and pins."""
        layers = mesh.uv_layers if self.kind == UV_MAP else mesh.attributes
        if self.name in layers:
            layers.remove(layers[self.name])

    def _values(self, mesh):
        """Its `compatibility.Values`."""
        if self.kind == UV_MAP:
            return [Values(mesh.uv_layers[self.name].data, *each) for each in UV_VALUES]
        return [Values(mesh.attributes[self.name].data, *KINDS[self.kind])]


class MeshState:
    """The state of a mesh. @pre the mesh is not in edit mode, now or when restored"""

    def __init__(self, mesh):
        self._mesh, self.copy = mesh, mesh.copy()

    def restore(self):
        """Puts the mesh back, bit for bit."""
        mesh, copy = self._mesh, self.copy
        if _sizes(mesh) != _sizes(copy):
            _restore_elements(mesh, copy)
        if list(mesh.materials) != list(copy.materials):
            mesh.materials.clear()  # `pop` would leave the objects a last slot
            for material in copy.materials:
                mesh.materials.append(material)
        _restore_layers(mesh, copy)
        seams = mesh_io.read_seams(copy)
        if not np.array_equal(mesh_io.read_seams(mesh), seams):
            mesh_io.write_values(Values(mesh.edges, "use_seam", bool), seams)  # no attribute before Blender 3.6
        _restore_active(mesh, copy)
        restore_properties(mesh, own_properties(copy))
        mesh.update()


def _sizes(mesh):
    return [len(elements) for elements in (mesh.vertices, mesh.edges, mesh.polygons, mesh.loops)]


def _restore_elements(mesh, copy):
    edited = bmesh.new()
    try:
        edited.from_mesh(copy)
        edited.to_mesh(mesh)
    finally:
        edited.free()


def _restore_layers(mesh, copy):
    """Writes layers that differ. Those behind one that was removed are made again, for their order."""
    found, wanted = _layers(mesh), _layers(copy)
    same = 0
    while same < min(len(found), len(wanted)) and found[same] == wanted[same]:
        same += 1
    for layer in found[same:]:
        layer.remove_from(mesh)
    for layer in wanted[same:]:
        layer.add_to(mesh)
    for index, layer in enumerate(wanted):
        before = layer.read(copy)
        if index >= same or any(a.tobytes() != b.tobytes() for a, b in zip(layer.read(mesh), before)):
            layer.write(mesh, before)


def _layers(mesh):
    """All layers that can be made again, in order."""
    maps = [] if bpy.app.version >= (3, 5, 0) else [Layer(layer.name, "CORNER", UV_MAP) for layer in mesh.uv_layers]
    others = [Layer(a.name, a.domain, a.data_type) for a in mesh.attributes]
    return maps + [layer for layer in others if layer.kind in KINDS and layer.name not in FIXED]


def _restore_active(mesh, copy):
    attribute = getattr(copy.attributes.active, "name", "")
    if attribute in mesh.attributes:
        mesh.attributes.active = mesh.attributes[attribute]
    for name in COLOURS:
        value = getattr(copy.attributes, name)
        if getattr(mesh.attributes, name) != value:
            setattr(mesh.attributes, name, value)
    for use in USES:
        for layer in copy.uv_layers:
            if getattr(layer, use):
                setattr(mesh.uv_layers[layer.name], use, True)
