# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of the active UV map of a mesh, measured and written as attributes of the faces: heat maps. And its
texels per metre, which are set by scaling the map: a seamless tiling by whole numbers alone, for any other factor would
open its seams."""

import math

import numpy as np

from ..native import holomorph
from ..scene import mesh_io, stored_dials, uv_maps

DENSITY, ANGLE, DIRECTION = "Holomorphic Density", "Holomorphic Angle", "Holomorphic Direction"  # attributes


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
    mesh_io.write_face_values(obj.data, DIRECTION, found.direction)
    return found


def refresh(obj):
    """Writes the attributes again where they are: another map has become active."""
    if mesh_io.is_attribute(obj.data, DENSITY, "FACE", "FLOAT") and is_possible(obj):
        write(obj)


def why_no_texels(target):
    """Why there is nothing to measure or to scale, one sentence, or ""."""
    if target.refused:
        return target.refused
    return "" if target.find().data.uv_layers.active else "it has no UV map"


def texels(target, image, metres):
    """Texels per metre of an image `image` texels wide, the median by area, for poles have no end of them; of a mesh
    that is not being edited. 0 where there is no area.

    metres : of a unit of the scene
    """
    return holomorph.distortion.length_ratio(target.polygons, _uv(target)) * image / metres


def scale_texels(target, factor):
    """Scales the active map about the middle of its bounding box; returns the factor that was taken."""
    mesh, uv = target.find().data, _uv(target)
    middle = (uv.min(axis=0) + uv.max(axis=0)) / 2
    if _is_tiling(target):
        factor = max(1, round(factor))
        scaled = holomorph.arrangement.on_grid(factor * uv.astype(np.float64)).astype(np.float32)
    else:
        scaled = middle + factor * (uv - middle)
    uv_maps.overwrite_map(mesh, target.polygons, mesh.uv_layers.active.name, scaled)
    return factor


def is_met(wanted, factor, before):
    """Whether a map with this number of texels has the wanted number after scaling."""
    return math.isclose(before * factor, wanted, rel_tol=1e-3)


def _uv(target):
    return active_map(target.find().data, target.polygons)


def _is_tiling(target):
    obj = target.find()
    is_main = obj.data.uv_layers.active.name == uv_maps.main_map(obj.data)
    made = stored_dials.made(obj)
    return is_main and made is not None and made.is_tiled
