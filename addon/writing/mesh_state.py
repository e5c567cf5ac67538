# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as it was: its UV maps and attributes in their order, its seams, its materials, and what of them is active.

It is kept as a copy, which from Blender 4.0 on shares with the mesh whatever is not changed.
"""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from ..compatibility import Values
from ..scene import attributes, mesh_io
from . import states

UV_MAP = "UV_MAP"  # kind of the layers that are not attributes: UV maps before Blender 3.5
UV_VALUES = ("uv", np.float32, 2), ("pin_uv", bool), ("select", bool), ("select_edge", bool)
FIXED = {"position", ".edge_verts", ".corner_vert", ".corner_edge"}  # Blender removes none of these
KINDS = attributes.VALUES | {
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
        states.restore_properties(mesh, states.own_properties(copy))
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
