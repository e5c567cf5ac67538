# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of an object raised by a picture that repeats in its tiles. No bpy here: it runs in a worker thread."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from .. import native
from ..materials import textures
from ..materials.nodes import CENTRE_NODE, REPEATS_NODE
from ..native import holomorph
from . import parts

AUTOMATIC_DEPTH = 0.1  # in sides of a tile
TWO_CHANNELS = (1, 1 / textures.STEPS, 0)  # of `textures.relief_image`


def shown_heights(material):
    """(the image behind the heights of the material's bumps or displacement, how often it lies across a tile); None
    without any."""
    tree = getattr(material, "node_tree", None)
    for node in tree.nodes if tree else ():
        image = _image_behind(node.inputs["Height"]) if node.type in ("BUMP", "DISPLACEMENT") else None
        if image is not None:
            repeats = tree.nodes.get(REPEATS_NODE)
            return image, round(repeats.outputs[0].default_value) if repeats else 1
    return None, 1


def about_centre(heights, material):
    """(h, w) heights as the material moves its images: with the centre of their turns at the corners. Parts of pixels
    are linear between them."""
    node = material.node_tree.nodes.get(CENTRE_NODE)
    if node is None:
        return heights
    u, v, _ = node.inputs[1].default_value
    for axis, pixels in ((0, v * heights.shape[0]), (1, -u * heights.shape[1])):  # the top row is the first
        whole = math.floor(round(pixels, 3))
        part = round(pixels, 3) - whole
        moved = (np.roll(heights, whole + k, axis) for k in (0, 1))
        heights = (1 - part) * next(moved) + part * next(moved)
    return heights


def channel_weights(image):
    """What red, green and blue count in a height; None where it is the brightness."""
    return TWO_CHANNELS if image.get(textures.OURS, "").endswith(textures.RELIEF) else None


def _image_behind(socket):
    for link in socket.links:
        node = link.from_node
        if node.type == "TEX_IMAGE":
            return node.image
        found = next(filter(None, map(_image_behind, node.inputs)), None)
        if found is not None:
            return found
    return None


def heights_of(pixels, weights):
    """(h, w) heights, the top row first, of (h, w, channels) pixels, the lowest row first, and what red, green and blue
    count; None for their brightness. @throws ValueError"""
    if not pixels.size:
        raise ValueError("it has no pixels: check that its file exists")
    colours = pixels[::-1, :, :3].astype(np.float64)
    if weights is not None:
        heights = np.clip(colours @ weights, 0, 1)
    else:
        channels = np.moveaxis(colours, 2, 0)
        heights = holomorph.files.picture_values.brightness(*channels) if len(channels) == 3 else channels[0]
    return holomorph.tiles.relief.checked_heights(heights)


def turned_over(polygons, uv):
    """`mesh_io.Polygons` and (#C, 2) UVs with the corners of each face the other way round, as a mirrored object shows
    them."""
    starts, ends = polygons.face_offsets[:-1], polygons.face_offsets[1:]
    back = np.repeat(starts + ends - 1, ends - starts) - np.arange(len(polygons.corner_vertices))
    return replace(polygons, corner_vertices=polygons.corner_vertices[back], loops=None), uv[back]


@dataclass
class RaisingWork(parts.PartsWork):
    """Raises every part that has a tiling, others stay as they are; then `found` is the one `holomorph.Relief` of all.
    `find` is not needed."""

    heights: np.ndarray = None  # (h, w)
    depth: float = 0.0  # 0 for `AUTOMATIC_DEPTH`
    options: dict = field(default_factory=dict)  # of `holomorph.TiledSurface.relief`
    skipped: int = 0
    inside_out: int = 0  # closed parts

    def look(self, tiled, ask):
        self.depth = self.depth or AUTOMATIC_DEPTH * _side(tiled)
        try:
            return tiled.relief(self.heights, self.depth, progress=ask, **self.options)
        except ValueError as error:
            self.problem = str(error)
            return None

    def skip(self, part):
        self.skipped += 1
        self.found.append(holomorph.tiles.relief.plain(part))

    def work(self):
        super().work()
        if self.problem:
            return
        shells = native.module("tiles.shells")
        self.inside_out = len(shells.inside_out(self.parts))
        made = holomorph.tiles.relief.joined(self.found)
        if not self.watch(parts.FOUND, "crossings"):
            raise holomorph.Cancelled("cancelled during the search for crossing triangles")
        made.safe_depth  # noqa: B018  which is kept
        self.found = [made]


def _side(tiled):
    """The side of a tile of the middle size, in the unit of the positions."""
    corners = tiled.uv[tiled.surface.triangle_corners]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    area = np.abs(ax * by - ay * bx).sum() / 2
    return float(np.sqrt(tiled.surface.area / area)) if area > 0 else 0.0


def sentence(relief, millimetres, work):
    """The sentence that tells of a relief. millimetres : in a unit of its positions; work : its `RaisingWork`"""
    rounded = holomorph.core.value.rounded
    told = [f"{len(relief.triangles):,} triangles, {relief.depth * millimetres:.3g} mm deep"]
    if work.skipped:
        told.append(f"{work.skipped} parts without a tiling stay flat")
    if work.inside_out:
        told.append(f"inside out: {work.inside_out} closed parts; recalculate their normals")
    rows, columns = work.heights.shape
    if rows != columns:
        told.append(holomorph.tiles.relief.stretched_sentence(columns, rows))
    if relief.is_full:
        off = relief.error * relief.depth * millimetres
        told.append(f"up to {rounded(off)} mm off: allow more triangles to follow the picture")
    if len(relief.crossings):
        safe = relief.safe_depth * millimetres
        least = relief.depth * holomorph.tiles.relief.LEAST_PART * millimetres
        told_of = f"up to {rounded(safe)} mm deep it does not" if safe else f"at {rounded(least)} mm it still does"
        told.append(f"it crosses itself in {len(np.unique(relief.crossings)):,} triangles: {told_of}")
    return "; ".join(told)
