# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfers maps, materials, edge marks and attributes from a mesh to its levels of detail."""

from dataclasses import dataclass

import numpy as np

from .. import compatibility
from ..compatibility import Values
from ..scene import mesh_io, uv_maps

# Attributes of Blender's own, or that are written in another way here.
BUILT_IN = {"position", "material_index", "sharp_face", "shade_smooth", "id", "normal"}
EDGE_MARKS = ("use_seam", "use_edge_sharp")
FACE_VALUES = {"material_index": np.int32, "use_smooth": bool}


@dataclass(frozen=True)
class Attribute:
    name: str
    domain: str
    kind: str
    values: np.ndarray  # one row for each point, face or corner; corners in the polygons' order


@dataclass(frozen=True)
class MeshData:
    """What a mesh has besides its polygons; corners in the polygons' order."""

    positions: np.ndarray  # (#V, 3) float32, in the object's own frame
    maps: list  # names
    own_maps: list  # those that were made here
    uv: np.ndarray  # (#C, m, 2) float64
    active: str  # map in the editors, empty if there is none
    rendered: str
    attributes: list
    faces: dict  # name in `FACE_VALUES`: (#F,)
    marks: dict  # mark: (n, 2) vertices of the edges that have it
    colour: str  # active colour attribute


def read(mesh, polygons):
    """All that levels get from `mesh`. Its maps include those of ours that are attributes for want of a UV map slot."""
    layers = [layer.name for layer in mesh.uv_layers]
    others = [a.name for a in mesh.attributes if uv_maps.is_own_attribute(mesh, a) and a.name not in layers]
    maps = layers + others
    uv = np.empty((len(polygons.corner_vertices), len(maps), 2))
    for index, name in enumerate(maps):
        uv[:, index] = uv_maps.read_corners(mesh, polygons, name)
    return MeshData(
        positions=mesh_io.read_values(compatibility.position_values(mesh)),
        maps=maps,
        own_maps=uv_maps.own_maps(mesh),
        uv=uv,
        active=getattr(mesh.uv_layers.active, "name", ""),
        rendered=next((layer.name for layer in mesh.uv_layers if layer.active_render), ""),
        attributes=[_read_attribute(a, polygons) for a in mesh.attributes if _is_transferred(a, maps)],
        faces={name: mesh_io.read_values(Values(mesh.polygons, name, kind)) for name, kind in FACE_VALUES.items()},
        marks={name: mesh_io.marked_edges(mesh, name) for name in EDGE_MARKS},
        colour=getattr(mesh.color_attributes.active_color, "name", ""),
    )


def write(mesh, data, level, names):
    """Writes the data to `mesh`, which has the triangles of `level`; `names` are those of the level's maps."""
    surface = level.surface
    own = mesh_io.Polygons(data.positions, surface.corner_vertices, surface.face_offsets, None)
    for index, name in enumerate(names):
        uv_maps.write_map(mesh, own, name, level.uv[:, index])
    uv_maps.add_own_maps(mesh, data.own_maps + [name for name in names if name not in data.maps])
    _show(mesh, data, names)
    for name, kind in FACE_VALUES.items():
        mesh_io.write_values(Values(mesh.polygons, name, kind), data.faces[name][surface.face_index])
    rows = {"POINT": surface.vertex_index, "FACE": surface.face_index, "CORNER": level.corners}
    for attribute in data.attributes:
        new = mesh.attributes.new(attribute.name, attribute.kind, attribute.domain)
        mesh_io.write_values(_attribute_values(mesh.attributes[new.name]), attribute.values[rows[attribute.domain]])
    for name, ends in ((name, ends) for name, ends in data.marks.items() if len(ends)):
        mapped = level.vertex_map[ends]
        mesh_io.mark_edges(mesh, name, mapped[(mapped[:, 0] != mapped[:, 1]) & (mapped >= 0).all(axis=1)])
    if data.colour in mesh.color_attributes:
        mesh.color_attributes.active_color = mesh.color_attributes[data.colour]
    mesh.update()


def _show(mesh, data, names):
    """Makes the same maps active; where one had to be made, that one."""
    added = [name for name in names if name not in data.maps]
    for name in (data.active, *added):
        if name in mesh.uv_layers:
            mesh.uv_layers.active = mesh.uv_layers[name]
    for name in (data.rendered, *added):
        if name in mesh.uv_layers:
            mesh.uv_layers[name].active_render = True


def _is_transferred(attribute, maps):
    name, built_in = attribute.name, attribute.name in BUILT_IN or attribute.name.startswith(".")
    return (
        attribute.domain in {"POINT", "FACE", "CORNER"}
        and attribute.data_type in compatibility.ATTRIBUTES
        and not (built_in or name in maps)
    )


def _read_attribute(attribute, polygons):
    values = mesh_io.read_values(_attribute_values(attribute))
    if attribute.domain == "CORNER":
        values = polygons.of_corners(values)
    return Attribute(attribute.name, attribute.domain, attribute.data_type, values)


def _attribute_values(attribute):
    return Values(attribute.data, *compatibility.ATTRIBUTES[attribute.data_type])
