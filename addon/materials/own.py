# SPDX-License-Identifier: GPL-3.0-or-later
"""Images and materials of the user's as textures: what is known of them before they are shown."""

import functools
import math
import zlib
from dataclasses import dataclass

import bpy

from .. import compatibility, native
from ..native import holomorph
from ..scene import image_io
from . import own_nodes
from .nodes import OURS

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

    @property
    def block(self):
        """The image or the material; None where it is gone."""
        return _blocks(self.kind).get((self.name, None)) or _blocks(self.kind).get(self.name)


def chosen(properties):
    """The `Own` of properties of an operator, or of the headless command; None where the texture is one of ours.
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


def _blocks(kind):
    return bpy.data.images if kind == IMAGE else bpy.data.materials


def _of_image(own, image, lattice):
    found = periodicity(image)
    height = image.size[1] / image.size[0]
    if lattice == AUTOMATIC:
        return Own(own.kind, own.name, _as_tuple(found.lattice), height, text=found.text)
    return _told(own, lattice, height, found.text)


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
    found = [periodicity(image) for image in images]
    text = _text(found)
    if lattice != AUTOMATIC:
        return _told(own, lattice, height, text)
    alike = {_as_tuple(one.lattice) for one in found}
    if len(alike) == 1 and own_nodes.only_images_read(material.node_tree):
        return Own(own.kind, own.name, alike.pop(), height, text=text)
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


def periodicity(image):
    """The `holomorph.ImageLattice` of an image. @throws ValueError it has no pixels, or is several pictures"""
    reason = _why_not(image)
    if reason:
        raise ValueError(f"{image.name} {reason}")
    pixels = image_io.read_pixels(image)
    try:
        return _periodicity(_Pixels(pixels))
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
def _periodicity_of(key):
    return holomorph.image_lattice(key.values)


def _periodicity(pixels):
    found = _periodicity_of(pixels)
    pixels.values = None  # not kept
    return found


def _as_tuple(matrix):
    return tuple(map(tuple, matrix.tolist()))
