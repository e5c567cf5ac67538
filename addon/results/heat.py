# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat maps: the distortion of the active UV map of a mesh, measured and written as attributes of the faces."""

from ..native import holomorph
from ..scene import mesh_io, uv_maps

DENSITY, ANGLE = "Holomorphic Density", "Holomorphic Angle"  # attributes


def is_possible(obj):
    return obj.data.uv_layers.active is not None and len(obj.data.polygons) > 0


def measured(mesh, linear):
    """(polygons, the `holomorph.distortion.Distortion` of their active UV map) of a mesh that is not being edited, its
    positions multiplied by the 3x3 matrix `linear`."""
    polygons = mesh_io.read_polygons(mesh, linear)
    return polygons, holomorph.distortion.measure(polygons, active_map(mesh, polygons))


def active_map(mesh, polygons):
    """(#C,2) float32 of the active UV map, in the order of the polygons' corners."""
    return uv_maps.read_corners(mesh, polygons, mesh.uv_layers.active.name)


def write(obj):
    """Writes the attributes; returns the `holomorph.distortion.Distortion`."""
    _, found = measured(obj.data, obj.matrix_world.to_3x3())
    mesh_io.write_face_values(obj.data, DENSITY, found.density)
    mesh_io.write_face_values(obj.data, ANGLE, found.angle)
    return found


def refresh(obj):
    """Writes the attributes again where they are: another map has become active."""
    if mesh_io.is_attribute(obj.data, DENSITY, "FACE", "FLOAT") and is_possible(obj):
        write(obj)
