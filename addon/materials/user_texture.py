# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and materials of the user's as textures: what is known of them before they are shown."""

import functools
import math
import zlib
from dataclasses import dataclass, replace

import bpy

from .. import compatibility, native
from ..native import holomorph
from ..scene import image_io
from . import averages
from .nodes import CENTRE_NODE, HEIGHT_NODE, IMAGE_NODE, OURS, REPEATS_NODE, Tree

IMAGE, MATERIAL = "IMAGE", "MATERIAL"  # kinds
AUTOMATIC = "automatic"  # as a lattice: the one that the image has
STILL = {"FILE", "GENERATED", "VIEWER"}  # sources of images that are one picture
SHIFTS = {"brick": 0.5}  # by which every other row of images is moved, in their widths
HEXAGONS = "hex"


@dataclass(frozen=True)
class Own:
    """A texture of the user's, one UV unit wide."""

    kind: str
    name: str
    lattice: object  # of translations that leave it as it is: one that the user names, or (2, 2)
    height: float = 1.0  # of an image, in its width
    shift: float = 0.0  # by which each row of images lies beside the one below it, in its width
    text: str = ""  # what was found, a sentence
    turns: int = 1  # 2, 4 or 6: it looks the same after this part of a full turn
    centre: tuple = (0.0, 0.0)  # about which, in images
    averaged: int = 1  # 2 or 4: only since it is averaged over these turns
    alike: float = 0.0  # correlation of an image that is averaged with itself after the turn

    def on_turned(self, turns):
        """As it lies on a map whose sides turn by this part of a full turn: its centre at the corners of tiles."""
        height = math.sqrt(3) if turns == 6 else self.height
        if turns == 1:
            return replace(self, height=height, centre=(0.0, 0.0), averaged=1)
        return replace(self, height=height)

    @property
    def block(self):
        """The image or the material; None where it is gone."""
        return _blocks(self.kind).get((self.name, None)) or _blocks(self.kind).get(self.name)


def chosen(properties):
    """The `Own` of properties of an operator; None where the texture is one of ours.
    @throws ValueError there is none, or it cannot be a texture"""
    kind = properties.texture
    if kind not in (IMAGE, MATERIAL):
        return None
    found = Own(kind, properties.source, AUTOMATIC)
    if not properties.source:
        raise ValueError(f"Choose {'an image' if kind == IMAGE else 'a material'}")
    if found.block is None:
        raise ValueError(f"There is no {kind.lower()} {properties.source!r}")
    lattice = getattr(properties, "lattice", AUTOMATIC)
    return _of_image(found, found.block, lattice) if kind == IMAGE else _of_material(found, found.block, lattice)


def symmetric(own, turns):
    """The `Own` that is averaged over the turns of a map, about the centre where it is most like itself. @throws
    ValueError it cannot be"""
    if own.averaged == turns or own.turns % turns == 0:
        return own
    images = [own.block] if own.kind == IMAGE else images_of(own.block.node_tree)
    if turns not in (2, 4) or own.height != 1:
        what = "squares: set Turns to Half or Quarter" if turns not in (2, 4) else "square images"
        raise ValueError(f"{own.name}: Make Symmetric is for {what}")
    if not images or (own.kind == MATERIAL and not only_images_read(own.block.node_tree)):
        raise ValueError(f"{own.name}: Make Symmetric is for materials whose UVs go to images alone")
    alike, centre = _most_like(_Pixels(image_io.read_pixels(images[0])), turns)
    return replace(own, turns=turns, centre=centre, averaged=turns, alike=max(alike, 0.0))


def _blocks(kind):
    return bpy.data.images if kind == IMAGE else bpy.data.materials


def _of_image(own, image, lattice):
    found, turns = symmetries(image)
    height = image.size[1] / image.size[0]
    if lattice == AUTOMATIC:
        made = Own(own.kind, own.name, _as_tuple(found.lattice), height, text=found.text)
    else:
        made = _told(own, lattice, height, found.text)
    return _with_turns(made, [turns] if found.tiles else [])


def _with_turns(own, found):
    """The `Own` with the turns after which all images look the same: of square ones, or of hexagons."""
    alike = {(one.turns, one.centre) for one in found}
    turns, centre = alike.pop() if len(alike) == 1 else (1, (0.0, 0.0))
    if turns in (2, 4) and own.height != 1:
        turns, centre = 1, (0.0, 0.0)
    text = f"{own.text}. {found[0].text}" if found else own.text
    return replace(own, turns=turns, centre=centre, text=text)


def _told(own, lattice, height, text):
    """The `Own` that repeats as the user says: in rows, in shifted rows, or as an image whose middle is like its
    corners.
    """
    if lattice == HEXAGONS:
        return Own(own.kind, own.name, lattice, math.sqrt(3), text=text)
    shift = SHIFTS.get(lattice, 0.0)
    return Own(own.kind, own.name, ((1.0, shift), (0.0, height)), height, shift, text)


def _of_material(own, material, lattice):
    """A material repeats with its images, as high as these are; by a finer lattice where it is that of all of them, and
    nothing else reads UVs."""
    if OURS in material:
        raise ValueError(f"{own.name} shows a texture from this menu: choose that one")
    if not compatibility.has_nodes(material):
        raise ValueError(f"{own.name} has no nodes")
    images = images_of(material.node_tree)
    sizes = {image.size[1] / image.size[0] for image in images}
    height = sizes.pop() if len(sizes) == 1 else 1.0
    found, turns = zip(*map(symmetries, images)) if images else ((), ())
    text = _text(found)
    if lattice != AUTOMATIC:
        return _told(own, lattice, height, text)
    alike = {_as_tuple(one.lattice) for one in found}
    if len(alike) == 1 and only_images_read(material.node_tree):
        made = Own(own.kind, own.name, alike.pop(), height, text=text)
        return _with_turns(made, turns if all(one.tiles for one in found) else [])
    return Own(own.kind, own.name, ((1.0, 0.0), (0.0, height)), height, text=text.split(";")[0])


def _text(found):
    """The sentence on the images of a material: the first that does not tile, or the first."""
    if not found:
        return "It has no images, so it is assumed to repeat in each UV unit"
    return next((one.text for one in found if not one.tiles), found[0].text)


def images_of(tree):
    """The pictures in a node tree and in its groups that can be read, each once."""
    found = {}
    for node in tree.nodes:
        if node.type == "TEX_IMAGE" and node.image is not None and _why_not(node.image) == "":
            found[node.image] = True
        elif node.type == "GROUP" and node.node_tree is not None:
            found |= dict.fromkeys(images_of(node.node_tree), True)
    return list(found)


def symmetries(image):
    """The `holomorph.ImageLattice` and the `holomorph.ImageTurns` of an image. @throws ValueError it has no pixels, or
    is several pictures"""
    reason = _why_not(image)
    if reason:
        raise ValueError(f"{image.name} {reason}")
    pixels = image_io.read_pixels(image)
    try:
        return _symmetries(_Pixels(pixels))
    except ValueError as error:
        raise ValueError(f"{image.name}: {native.sentence(error)}") from error


def _why_not(image):
    if image.source not in STILL:
        return "is more than a single picture"
    return "" if min(image.size) > 0 and len(image.pixels) else "has no pixels: check that its file exists"


class _Pixels:
    """An array that is equal to others with its values: the redo panel asks for the same image again and again."""

    def __init__(self, values):
        self.values, self._key = values, (values.shape, zlib.crc32(values))

    def __hash__(self):
        return hash(self._key)

    def __eq__(self, other):
        return self._key == other._key


@functools.lru_cache(maxsize=16)
def _symmetries_of(key):
    return holomorph.image_lattice(key.values), holomorph.image_turns(key.values)


def _symmetries(pixels):
    found = _symmetries_of(pixels)
    pixels.values = None  # not kept
    return found


@functools.lru_cache(maxsize=16)
def _most_like_of(key, turns):
    return native.module("tiling.images").most_like(key.values, turns)


def _most_like(pixels, turns):
    found = _most_like_of(pixels, turns)
    pixels.values = None
    return found


def _as_tuple(matrix):
    return tuple(map(tuple, matrix.tolist()))


SHIFT_NODE = "Row Shift"
ROUGHNESS = 0.6
LEFT = -900  # of what is added to the user's nodes, from the leftmost of them, in the editor's units
TANGENTS = {"NORMAL_MAP", "TANGENT"}  # types of nodes whose vectors are those of a UV map
UNLINKED = {"TEX_IMAGE"}  # types of nodes that read the active UV map where nothing is linked


def build_image(material, map_name, is_attribute, repeats, own):
    """The image, laid on by the map."""
    tree = Tree.of(material)
    picture = tree.node("ShaderNodeTexImage", -360, 200, IMAGE_NODE, image=own.block)
    places = _places(tree, tree.map_vector(map_name, is_attribute), repeats, own)
    tree.link(places, picture.inputs["Vector"])
    tree.link(picture.outputs[0], tree.shader(ROUGHNESS).inputs["Base Color"])
    tree.show_in_solid_view(picture)
    if own.averaged != 1:
        averages.put(tree.tree, own.averaged, own.centre, own.alike)


def adjust(material, repeats, own):
    """The image and numbers of what `build_image` made, where the user has not rebuilt them."""
    nodes = material.node_tree.nodes
    if IMAGE_NODE in nodes:
        nodes[IMAGE_NODE].image = own.block
    for name, value in _numbers(repeats, own).items():
        if name in nodes:
            nodes[name].outputs[0].default_value = value
    if CENTRE_NODE in nodes:
        nodes[CENTRE_NODE].inputs[1].default_value = (*own.centre, 0)


def _numbers(repeats, own):
    return {REPEATS_NODE: repeats, HEIGHT_NODE: own.height, SHIFT_NODE: own.shift}


def redirect(tree, map_name, is_attribute, repeats, own):
    """Lets all nodes that read a UV map read this one, in the groups of the node tree as well, which are copied."""
    places, groups = None, {}
    for node in list(tree.nodes):
        if node.type == "GROUP" and node.node_tree is not None:
            if node.node_tree not in groups:
                groups[node.node_tree] = node.node_tree.copy()
                redirect(groups[node.node_tree], map_name, is_attribute, repeats, own)
            node.node_tree = groups[node.node_tree]
        elif node.type in TANGENTS:
            node.uv_map = map_name
    for socket in _reading(tree):
        if places is None:
            places = _places_in(tree, map_name, is_attribute, repeats, own)
        tree.links.new(places, socket)
    if places is not None and own.averaged != 1:
        averages.put(tree, own.averaged, own.centre, own.alike)


def groups(tree):
    """The node trees of the groups in a tree that `redirect` was given."""
    inside = {node.node_tree for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None}
    return inside.union(*map(groups, inside))


def only_images_read(tree):
    """Whether UVs go to images only, in groups of the tree as well."""
    inside = [node.node_tree for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None]
    own = all(link.to_node.type == "TEX_IMAGE" for link in tree.links if _gives_uvs(link))
    return own and all(map(only_images_read, inside))


def _reading(tree):
    """The inputs that take UVs: of links from nodes that give some, and of images without a link."""
    given = [link.to_socket for link in tree.links if _gives_uvs(link)]
    images = [node.inputs["Vector"] for node in tree.nodes if node.type in UNLINKED]
    return given + [socket for socket in images if not socket.is_linked]


def _gives_uvs(link):
    node = link.from_node
    return node.type == "UVMAP" or (node.type == "TEX_COORD" and link.from_socket.name == "UV")


def _places_in(tree, map_name, is_attribute, repeats, own):
    """The socket of `_places`, left of the user's nodes."""
    added = Tree(tree, min(node.location.x for node in tree.nodes) + LEFT)
    return _places(added, added.map_vector(map_name, is_attribute, label=""), repeats, own)


def _places(tree, vector, repeats, own):
    """The socket of UVs in images: v over their height, and each row of images moved beside the one below it."""
    sockets = []
    for row, (name, value) in enumerate(_numbers(repeats, own).items()):
        sockets.append(tree.node("ShaderNodeValue", -900, -120 - 100 * row, name).outputs[0])
        sockets[-1].default_value = value
    times, height, shift = sockets
    apart = tree.node("ShaderNodeSeparateXYZ", -740, 100)
    tree.link(tree.scaled(vector, times, -820, 200), apart.inputs[0])
    up = tree.number("DIVIDE", apart.outputs["Y"], height, x=-680)
    row = tree.number("FLOOR", up, x=-620)
    moved = tree.number("MULTIPLY", row, shift, x=-560)
    along = tree.number("SUBTRACT", apart.outputs["X"], moved, x=-500)
    places = tree.node("ShaderNodeCombineXYZ", -440, 100)
    for value, name in ((along, "X"), (up, "Y")):
        tree.link(value, places.inputs[name])
    if not any(own.centre):
        return places.outputs[0]
    moved = tree.node("ShaderNodeVectorMath", -380, 100, CENTRE_NODE, operation="ADD")
    moved.inputs[1].default_value = (*own.centre, 0)
    tree.link(places.outputs[0], moved.inputs[0])
    return moved.outputs[0]
