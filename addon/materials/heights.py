# SPDX-License-Identifier: GPL-3.0-or-later
"""The heights that a material shows."""

from . import textures
from .nodes import REPEATS_NODE

TWO_CHANNELS = (1, 1 / textures.STEPS, 0)  # of `textures.relief_image`


def shown(material):
    """(the image behind the heights of the material's bumps or displacement, how often it lies across a tile); None
    without any."""
    tree = getattr(material, "node_tree", None)
    for node in tree.nodes if tree else ():
        image = _image_behind(node.inputs["Height"]) if node.type in ("BUMP", "DISPLACEMENT") else None
        if image is not None:
            repeats = tree.nodes.get(REPEATS_NODE)
            return image, round(repeats.outputs[0].default_value) if repeats else 1
    return None, 1


def weights(image):
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
