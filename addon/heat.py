# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat maps: the distortion of the active UV map as attributes of the faces, and the switch that shows it."""

import bpy
from bpy.props import EnumProperty

SHOWN = "holomorphic_heat"  # property of the window manager: what the overlay shows
QUANTITIES = (
    ("NONE", "Off", "Show no heat map"),
    ("DENSITY", "Density", "Show where the texture is denser or coarser than at the median, by UV area"),
    ("ANGLE", "Angle", "Show where squares are sheared or stretched: s1 / s2, 1 where they stay squares"),
)
DENSITY, ANGLE = "Holomorphic Density", "Holomorphic Angle"  # attributes


def is_possible(obj):
    return obj.data.library is None and obj.data.uv_layers.active is not None and len(obj.data.polygons) > 0


def measured(mesh, linear):
    """(polygons, the `distortion.Distortion` of their active UV map) of a mesh that is not being edited, its positions
    multiplied by the 3x3 matrix `linear`."""
    from . import distortion, mesh_io

    polygons = mesh_io.read_polygons(mesh, linear)
    uv = mesh_io.read_map(mesh, mesh.uv_layers.active.name)
    uv = uv if polygons.loops is None else uv[polygons.loops]
    return polygons, distortion.measure(polygons.vertices, polygons.corner_vertices, polygons.face_offsets, uv)


def write(obj):
    """Writes the attributes; returns the `distortion.Distortion`."""
    from . import mesh_io

    _, found = measured(obj.data, obj.matrix_world.to_3x3())
    mesh_io.write_face_values(obj.data, DENSITY, found.density)
    mesh_io.write_face_values(obj.data, ANGLE, found.angle)
    return found


def refresh(obj):
    """Writes the attributes again where they are: another map has become active."""
    if DENSITY in obj.data.attributes and is_possible(obj):
        write(obj)


def _redraw(manager, _context):
    for window in manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def register():
    switch = EnumProperty(
        name="Heat Map", description="What is shown of the active UV map", items=QUANTITIES, update=_redraw
    )
    setattr(bpy.types.WindowManager, SHOWN, switch)


def unregister():
    delattr(bpy.types.WindowManager, SHOWN)
