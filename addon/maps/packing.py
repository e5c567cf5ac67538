# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands in the UV square without overlap, by Blender's own packer."""

import math
from contextlib import ExitStack, contextmanager
from dataclasses import replace

import bpy
import numpy as np

from .. import compatibility
from ..native import holomorph
from ..scene import mesh_io, uv_maps

MIDDLE = 0.5  # the middle of the UV square


def packed(context, mapped):
    """The `mapped.MappedObject` with its islands as Blender packs them, all by the same factor, and the density that
    its map has. They fill the UV square, unless a density is arranged, and stay upright where they are to be so."""
    arrangement, parts = mapped.arrangement, [part.surface for part in mapped.solved.done]
    _, shelves = next(replace(mapped, arrangement=replace(arrangement, density=1.0, per_length=0.0)).maps())
    corners, side_by_side = np.concatenate([part.corner_index for part in parts]), joined(parts)
    with mesh_of(context, side_by_side) as mesh:
        uv_maps.write_map(mesh, side_by_side, uv_maps.MAIN_MAP, shelves[corners])
        margin = holomorph.layout.fitting_margin(arrangement.margin, len(parts))
        pack(context, margin, rotate=mapped.request.direction is None)
        found = uv_maps.read_map(mesh, uv_maps.MAIN_MAP)
    square = holomorph.arrangement.square(mapped.part_maps, arrangement)
    filling = square.filling * _length(parts, found) / _length(parts, shelves[corners])
    arrangement = replace(arrangement, per_length=arrangement.per_length or filling)
    result = np.zeros_like(shelves)
    result[corners] = MIDDLE + arrangement.density * arrangement.per_length / filling * (found - MIDDLE)
    return replace(mapped, arrangement=arrangement, packed=result)


def cuts(parts):
    """(#S, 2) vertices of the mesh, of the edges along which these parts of it were cut: two boundaries have them."""
    ends = np.concatenate([part.vertex_index[holomorph.mesh.edges.boundary_edges(part)] for part in parts])
    rows, count = np.unique(np.sort(ends, axis=1), axis=0, return_counts=True)
    return rows[count > 1]


def _length(parts, uv):
    """The side of a square with the area of the map."""
    first, area = 0, 0.0
    for part in parts:
        count = len(part.corner_vertices)
        area += holomorph.frame(part, uv[first : first + count]).area
        first += count
    return math.sqrt(area)


@contextmanager
def mesh_of(context, polygons):
    """A mesh of these polygons, as the only object that is selected, and the active one; it is gone in the end."""
    layer, made = context.view_layer, []
    with ExitStack() as last_first:
        last_first.callback(setattr, layer.objects, "active", layer.objects.active)
        for other in compatibility.selected_in(layer):
            last_first.callback(other.select_set, True)
        last_first.callback(bpy.data.batch_remove, made)
        for other in compatibility.selected_in(layer):
            other.select_set(False)
        made.append(bpy.data.meshes.new("Holomorphic Islands"))
        made.append(bpy.data.objects.new(made[0].name, made[0]))
        mesh_io.fill(made[0], polygons.vertices, polygons.corner_vertices, polygons.face_offsets)
        context.scene.collection.objects.link(made[1])
        layer.objects.active = made[1]
        made[1].select_set(True)
        yield made[0]


def joined(parts):
    """The `mesh_io.Polygons` of surfaces side by side, without a common vertex: the packer joins none of them."""
    first_vertices = np.cumsum([0] + [len(part.vertices) for part in parts])
    first_corners = np.cumsum([0] + [len(part.corner_vertices) for part in parts])
    corners = [part.corner_vertices + first for part, first in zip(parts, first_vertices)]
    ends = [part.face_offsets[1:] + first for part, first in zip(parts, first_corners)]
    vertices = np.concatenate([part.vertices for part in parts])
    return mesh_io.Polygons(vertices, np.concatenate(corners), np.concatenate([[0], *ends]), None)


def pack(context, margin, rotate):
    """Packs the UVs of the active object. rotate : whether islands are turned, which takes less room"""
    with editing_all(context):
        # The margin is added before the packer's factor, which is near 1; an exact one would take several packings.
        bpy.ops.uv.pack_islands(rotate=rotate, margin_method="ADD", margin=margin)


@contextmanager
def editing_all(context):
    """Edit mode for the active object, with everything selected."""
    settings = context.scene.tool_settings
    with ExitStack() as last_first:
        last_first.callback(setattr, settings, "use_uv_select_sync", settings.use_uv_select_sync)
        settings.use_uv_select_sync = True  # what is selected is packed
        last_first.callback(bpy.ops.object.mode_set, mode="OBJECT")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        yield
