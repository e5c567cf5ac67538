# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of the textures as assets: the user's, to be dragged onto any object with a map of ours."""

import bpy

from ..scene.uv_maps import MAIN_MAP
from . import nodes, textures
from .patterns import TEXTURES

ASSET = "holomorph_asset"  # custom property that tells them: which texture
UNIT = 0.25  # length of a UV unit that reliefs are made for; a value in the nodes, "Relief", has them
TAG = "Seamless"


def add():
    """Makes and marks those that the file has not yet; gives them."""
    there = {material.get(ASSET) for material in bpy.data.materials if material.library is None}
    return [_made(texture) for texture in TEXTURES if texture not in there]


def _made(texture):
    made = bpy.data.materials.new(f"{textures.label(texture)} on Tiling")
    made[ASSET] = texture
    nodes.build_texture(made, texture, MAIN_MAP, is_attribute=False)
    nodes.adjust_texture(made, texture, 1, UNIT)
    made.asset_mark()
    made.asset_data.description = f"{textures.label(texture)} on the UV map {MAIN_MAP}, made by Seamless Tiling"
    made.asset_data.tags.new(TAG)
    if not bpy.app.background:  # a preview is a render
        made.asset_generate_preview()
    return made
