# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of materials that give off one channel as light, which a bake takes as it is: no lamp, no noise."""

from dataclasses import dataclass

EACH, ONE, UDIM = "EACH", "ONE", "UDIM"  # an image for each object, one for all, one with a tile for each
COLOUR, ROUGHNESS, METALLIC, HEIGHT, NORMAL = "COLOUR", "ROUGHNESS", "METALLIC", "HEIGHT", "NORMAL"
CHANNELS = (COLOUR, ROUGHNESS, METALLIC, HEIGHT, NORMAL)
USUAL_CHANNELS = frozenset({COLOUR, ROUGHNESS, NORMAL})
USUAL_SIDE = 2048  # texels of an image's side where no texels per metre are asked for
LEAST_SIDE, MOST_SIDE = 16, 16384


@dataclass(frozen=True)
class BakeOptions:
    """The dials of a bake."""

    channels: frozenset = USUAL_CHANNELS
    images: str = EACH
    texels: float = 0.0  # for a metre of the surface; 0: images have the usual side
    margin: int = 8  # texels around islands that show what their border shows
    folder: str = ""  # where images are saved; "" packs them into the file

    @property
    def room(self):
        """Texels that belong to each island around it: a margin, and one that rounding may take of it."""
        return self.margin + 1


SOCKETS = {COLOUR: ("Base Color", "Color"), ROUGHNESS: ("Roughness",), METALLIC: ("Metallic",)}
ABSENT = {ROUGHNESS: 1.0, METALLIC: 0.0, HEIGHT: 0.0}  # of shaders that do not have it
RELIEFS = {"BUMP", "DISPLACEMENT"}  # types of the nodes that have a height


class ChannelCopy:
    """A copy of a material, whose surface shows one channel after the other. @pre `check` has passed

    block : the copy
    """

    def __init__(self, block):
        self.block, self._tree = block, block.node_tree
        output, shader = _ends(self._tree)
        self._surface, self._shader = output.inputs["Surface"], shader
        self._sources = {channel: _named(shader.node, names) for channel, names in SOCKETS.items()}
        self._sources[HEIGHT] = _height(shader.node, output)
        self._light = self._tree.nodes.new("ShaderNodeEmission")
        self._target = self._tree.nodes.new("ShaderNodeTexImage")
        self._tree.nodes.active = self._target

    def show(self, channel, image):
        """Shows a channel, or its own shader where that is none of colours or numbers; bakes go to the image."""
        self._target.image = image
        if channel not in self._sources:
            self._tree.links.new(self._shader, self._surface)
            return
        source, light = self._sources[channel], self._light.inputs["Color"]
        for link in light.links:
            self._tree.links.remove(link)
        linked = _source(source) if source else None
        if linked:
            self._tree.links.new(linked, light)
        else:
            light.default_value = _colour(source.default_value if source else ABSENT[channel])
        self._tree.links.new(self._light.outputs[0], self._surface)


def check(material):
    """@throws ValueError a material with nodes has no colour"""
    _, shader = _ends(material.node_tree)
    if shader is None or _named(shader.node, SOCKETS[COLOUR]) is None:
        what = f"ends in {shader.node.bl_label}" if shader else "has no surface"
        raise ValueError(f"its material {material.name!r} {what}; only a shader with a colour can be baked")


def _ends(tree):
    """(the output node, the socket of the shader that goes there); None where there is none."""
    output = tree.get_output_node("CYCLES")
    return output, _source(output.inputs["Surface"]) if output else None


def _source(socket):
    """The socket that an input takes its value from, None without one."""
    while socket.is_linked:
        link = socket.links[0]
        if link.is_muted:
            return None
        if link.from_node.type != "REROUTE":
            return link.from_socket
        socket = link.from_node.inputs[0]
    return None


def _named(node, names):
    return next((node.inputs[name] for name in names if name in node.inputs), None)


def _height(shader, output):
    """The input with the height of a relief: of a bump, or of a displacement."""
    places = [node.inputs[name] for node, name in ((shader, "Normal"), (output, "Displacement")) if name in node.inputs]
    sources = [source for source in map(_source, places) if source]
    return next((source.node.inputs["Height"] for source in sources if source.node.type in RELIEFS), None)


def _colour(value):
    return (value,) * 3 + (1.0,) if isinstance(value, float) else tuple(value)
