# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of meshes side by side in the UV square, packed by Blender with room for margins."""

import math
from dataclasses import dataclass

import numpy as np

from ..maps import packing
from ..native import holomorph
from ..scene import uv_maps
from . import unfolding
from .channels import LEAST_SIDE, MOST_SIDE, USUAL_SIDE

FILLED = 0.5  # area of the islands before they are packed: about what they fill then
SHRUNK = 0.7  # by the packer, for the margins: about
MOST_MARGIN = 1.0  # that the packer takes
TRIES = 4  # packings until margins are wide enough
CLOSER = 1.05  # what a margin that was too narrow is widened by besides
NEAR = 0.999  # of a margin, for rounding


@dataclass(frozen=True, eq=False)
class Atlas:
    """The islands of some meshes in one image."""

    uvs: list  # (#C, 2) float32 of each mesh
    side: int  # texels
    texels: float  # for a metre of the surface, the median by area


def make(context, meshes, options):
    """The `Atlas` of `mesh_io.Polygons` whose positions are in metres. @throws ValueError there is no room"""
    joined = packing.joined(meshes)
    islands = unfolding.islands(context, joined, meshes)
    if not holomorph.distortion.length_ratio(joined, islands) > 0:
        raise ValueError("its faces have no area")
    with packing.mesh_of(context, joined) as mesh:
        uv_maps.write_map(mesh, joined, uv_maps.BAKE_MAP, np.zeros((len(joined.corner_vertices), 2), np.float32))
        uv, side, texels = _packed(context, mesh, joined, islands, options)
    ends = np.cumsum([len(one.corner_vertices) for one in meshes])
    return Atlas(np.split(uv, ends[:-1]), side, texels)


def _packed(context, mesh, joined, islands, options):
    """((#C, 2) UVs, side of the image, texels for a metre)."""
    ratio = holomorph.distortion.length_ratio
    uv = islands * np.float32(math.sqrt(FILLED / _area(joined, islands)))
    before = ratio(joined, uv)
    _side(options.texels, before)  # refuses at once what no packing changes
    margin = options.room * before / options.texels if options.texels else options.room / USUAL_SIDE / SHRUNK
    for _ in range(TRIES):
        if margin > MOST_MARGIN:
            break
        uv_maps.overwrite_map(mesh, joined, uv_maps.BAKE_MAP, uv)
        packing.pack(context, margin, rotate=True)
        found = uv_maps.read_map(mesh, uv_maps.BAKE_MAP)
        factor = ratio(joined, found) / before  # the packer's, of islands with their margins
        side = _side(options.texels, before * factor) if factor > 0 else 0
        width = margin * factor * side
        if width >= NEAR * options.room:
            return found, side, side * before * factor
        margin *= CLOSER * options.room / max(width, NEAR)
    raise ValueError(
        f"margins of {options.margin} texels leave no room for islands: ask for more texels or a smaller margin"
    )


def _area(polygons, uv):
    corners, _ = holomorph.distortion.fans(polygons.face_offsets)
    a, b = (uv[corners[:, side]].astype(np.float64) - uv[corners[:, 0]] for side in (1, 2))
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2


def _side(texels, per_metre):
    """The side of the image, in texels. @throws ValueError"""
    if not texels:
        return USUAL_SIDE
    side = math.ceil(texels / per_metre)
    if LEAST_SIDE <= side <= MOST_SIDE:
        return side
    limit, least = (MOST_SIDE, "at most") if side > MOST_SIDE else (LEAST_SIDE, "at least")
    image = f"an image of {side:,} texels a side" if side > 1 else "an image of 1 texel"
    allowed = f"{least} {limit:,} are possible, with {limit * per_metre:.4g} per metre"
    raise ValueError(f"{texels:g} texels per metre make {image}: {allowed}")
