# SPDX-License-Identifier: GPL-3.0-or-later
"""Texels per metre of the active UV maps of meshes: measured, and set by scaling the maps.

A seamless tiling is scaled by whole numbers alone, for any other factor would open its seams.
"""

import math

import numpy as np

from ..native import holomorph
from ..scene import uv_maps
from . import heat, report, stored


def why_not(target):
    """Why there is nothing to measure or to scale, one sentence, or ""."""
    if target.refused:
        return target.refused
    return "" if target.find().data.uv_layers.active else "it has no UV map"


def measured(target, image, metres):
    """Texels per metre of an image `image` texels wide, the median by area, for poles have no end of them; of a mesh
    that is not being edited. 0 where there is no area.

    metres : of a unit of the scene
    """
    return holomorph.distortion.length_ratio(target.polygons, _uv(target)) * image / metres


def scale(target, factor):
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
    return heat.active_map(target.find().data, target.polygons)


def _is_tiling(target):
    obj = target.find()
    is_main = obj.data.uv_layers.active.name == uv_maps.main_map(obj.data)
    return is_main and bool(stored.tilings(obj.get(report.PROPERTY)))
