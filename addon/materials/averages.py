# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that look the same after the turns of a map: node groups that average them, under a soft mask.

With R the turn about a place at the corner of the image, f(R^i x) has weights m(R^i x) that sum to 1: each is 1 in a
part of the image from which the turns make the whole. What is averaged has less contrast; it gets that back about the
mean colour (Heitz and Neyret 2018, doi:10.1145/3233304).
"""

import bpy
import numpy as np

from .. import compatibility
from ..scene import image_io
from .nodes import Tree

SOFT = 0.12  # of an image: half the width in which one part goes over into another
ROWS = 8  # of nodes in the editor
SAMPLES = 512  # pixels a side, at most, of which the mean is taken
NORMAL = np.array([0.5, 0.5, 1.0])  # a normal map where the surface is as it is
COLOURS = {"sRGB"}  # spaces whose values are not linear


def put(tree, turns, centre, alike):
    """Lets a group of nodes take the place of each image of a node tree that has a link to its vector.

    turns : 2 or 4; centre : of these, in images; alike : correlation of the image with itself after the turn
    """
    for node in [node for node in tree.nodes if node.type == "TEX_IMAGE" and node.inputs["Vector"].is_linked]:
        if node.image is None or not len(node.image.pixels):
            continue
        group = tree.nodes.new("ShaderNodeGroup")
        group.node_tree, group.label = _group(node, turns, centre, alike), f"Symmetric {node.image.name}"
        group.location = node.location.x, node.location.y + 40
        tree.links.new(node.inputs["Vector"].links[0].from_socket, group.inputs["Vector"])
        for name in ("Color", "Alpha"):
            for link in list(node.outputs[name].links):
                tree.links.new(group.outputs[name], link.to_socket)


def _group(node, turns, centre, alike):
    tree = bpy.data.node_groups.new(f"Symmetric {node.image.name}", "ShaderNodeTree")
    compatibility.add_socket(tree, "Vector", "NodeSocketVector")
    for name, kind in (("Color", "NodeSocketColor"), ("Alpha", "NodeSocketFloat")):
        compatibility.add_socket(tree, name, kind, is_output=True)
    made = _Group(tree)
    is_normal = any(link.to_node.type == "NORMAL_MAP" for link in node.outputs["Color"].links)
    centre = (*centre, 0.0)
    x, y = made.parts(made.vector("SUBTRACT", made.node("NodeGroupInput").outputs[0], centre))[:2]
    places = made.turned(x, y, made.number("MULTIPLY", x, -1.0), made.number("MULTIPLY", y, -1.0))
    parts = [made.part(value) for value in (x, y)]
    shares = made.turned(*parts, *(made.number("SUBTRACT", 1.0, part) for part in parts))
    colours, alphas, weights = [], [], []
    for quarters in range(0, 4, 4 // turns):
        share = shares[quarters]
        weights.append(made.number("MULTIPLY", *share) if turns == 4 else share[0])
        picture = made.node("ShaderNodeTexImage")
        for setting in ("image", "interpolation", "extension"):
            setattr(picture, setting, getattr(node, setting))
        made.link(made.vector("ADD", made.joined(*places[quarters], 0.0), centre), picture.inputs["Vector"])
        colour = picture.outputs["Color"]
        colour = made.turned_back(colour, quarters) if is_normal else colour
        colours.append(made.vector("SCALE", colour, weights[-1]))
        alphas.append(made.number("MULTIPLY", picture.outputs["Alpha"], weights[-1]))
    mean = NORMAL if is_normal else _mean(node.image)
    output = made.node("NodeGroupOutput")
    made.link(made.with_contrast(colours, weights, tuple(mean), alike), output.inputs["Color"])
    made.link(made.total(made.number, alphas), output.inputs["Alpha"])
    return tree


class _Group(Tree):
    """A tree of nodes whose inputs are sockets or values; methods give the socket of what they add."""

    def node(self, kind, **settings):
        count = len(self.tree.nodes)
        return super().node(kind, 180 * (count // ROWS), -220 * (count % ROWS), **settings)

    def made(self, node, values):
        for value, socket in zip(values, node.inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.link(value, socket)
            else:
                socket.default_value = value
        return node.outputs[0]

    def number(self, operation, *values):
        return self.made(self.node("ShaderNodeMath", operation=operation), values)

    def vector(self, operation, first, second):
        node = self.node("ShaderNodeVectorMath", operation=operation)
        if operation != "SCALE":
            return self.made(node, (first, second))
        self.link(second, node.inputs["Scale"])
        return self.made(node, (first,))

    def joined(self, *values):
        return self.made(self.node("ShaderNodeCombineXYZ"), values)

    def parts(self, vector):
        node = self.node("ShaderNodeSeparateXYZ")
        self.made(node, (vector,))
        return node.outputs[:]

    def turned(self, x, y, minus_x, minus_y):
        """What belongs to both coordinates of (x, y) after so many quarter turns."""
        return [(x, y), (minus_y, x), (minus_x, minus_y), (y, minus_x)]

    def part(self, value):
        """1 where the sine of a coordinate is above 0, else 0, softly: with -x it is 1 less that with x."""
        sine = self.number("SINE", self.number("MULTIPLY", value, 2 * np.pi))
        node = self.node("ShaderNodeMapRange", interpolation_type="SMOOTHSTEP")
        width = float(np.sin(2 * np.pi * SOFT))
        return self.made(node, (sine, -width, width, 0.0, 1.0))

    def turned_back(self, colour, quarters):
        """The normal of a surface that is turned by so many quarters, before that."""
        x, y, z = self.parts(colour)
        back = self.turned(x, y, *(self.number("SUBTRACT", 1.0, value) for value in (x, y)))[-quarters % 4]
        return self.joined(*back, z)

    def total(self, operation, values):
        result, *others = values
        for value in others:
            result = operation("ADD", result, value)
        return result

    def with_contrast(self, colours, weights, mean, alike):
        squares = self.total(self.number, [self.number("MULTIPLY", weight, weight) for weight in weights])
        variance = self.number("ADD", self.number("MULTIPLY", squares, 1.0 - alike), alike)
        off = self.vector("SUBTRACT", self.total(self.vector, colours), mean)
        off = self.vector("SCALE", off, self.number("POWER", variance, -0.5))
        return self.vector("MINIMUM", self.vector("MAXIMUM", self.vector("ADD", off, mean), (0,) * 3), (1,) * 3)


def _mean(image):
    """Linear red, green and blue."""
    pixels = image_io.read_pixels(image)
    steps = [max(1, size // SAMPLES) for size in pixels.shape[:2]]
    values = pixels[:: steps[0], :: steps[1], :3].astype(np.float64)
    if image.colorspace_settings.name in COLOURS and not image.is_float:
        values = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    return np.broadcast_to(values.mean(axis=(0, 1)), 3)
