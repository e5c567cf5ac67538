# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked images in the file: made of the bytes of image files, packed, or saved to a folder."""

import os
import tempfile
from pathlib import Path

import bpy

from .. import native
from ..native import holomorph
from .channels import COLOUR, HEIGHT

FIRST_TILE = 1001
TILES_ACROSS = 10
MOST_NAME = 50  # characters of what an image is named after: Blender has 63


def colour_space(channel):
    return "sRGB" if channel == COLOUR else "Non-Color"


def suffix(channel):
    """The end of the names of a channel's files: heights are of floating point."""
    return ".exr" if channel == HEIGHT else ".png"


def tile_offset(index):
    """(u, v) of a UDIM tile."""
    return index % TILES_ACROSS, index // TILES_ACROSS


def packed(channel, contents):
    """An image of the bytes of a file, or with a UDIM tile for each of several ones, that is packed."""
    image = _tiled(channel, contents) if len(contents) > 1 else _single(contents[0])
    image.colorspace_settings.name = colour_space(channel)
    return image


def name(image, channel, owner):
    image.name = f"{owner[:MOST_NAME]} {channel.title()}"


def save(images, contents, folder):
    """Moves images that are packed to files in a folder: all or none. @throws OSError

    images, contents : {channel: image}, {channel: bytes of each tile} of each atlas
    """
    place, names = Path(bpy.path.abspath(folder)), _file_names()
    with holomorph.files.whole_file.folder_beside(place / "baked") as new:
        for of_atlas, files in zip(images, contents):
            for channel, image in of_atlas.items():
                for index, content in enumerate(files[channel]):
                    (new / _file(image, names, channel, str(FIRST_TILE + index))).write_bytes(content)
    for of_atlas in images:
        for channel, image in of_atlas.items():
            image.filepath_raw = os.path.join(folder, _file(image, names, channel, "<UDIM>"))  # which loads nothing
            image.unpack(method="REMOVE")


def _file_names():
    """{name: file name without its end} of all images: none takes the file of another object's."""
    return native.module("files.names").told_apart([image.name for image in bpy.data.images], bpy.path.clean_name)


def _file(image, names, channel, tile):
    tile = f".{tile}" if image.source == "TILED" else ""
    return names[image.name] + tile + suffix(channel)


def _single(content):
    image = bpy.data.images.new("Baked", 1, 1, alpha=False)
    image.pack(data=content, data_len=len(content))
    image.source = "FILE"
    return image


def _tiled(channel, contents):
    with tempfile.TemporaryDirectory() as folder:
        for index, content in enumerate(contents):
            Path(folder, f"baked.{FIRST_TILE + index}{suffix(channel)}").write_bytes(content)
        image = bpy.data.images.load(str(Path(folder, f"baked.{FIRST_TILE}{suffix(channel)}")))
        image.source = "TILED"
        image.filepath_raw = str(Path(folder, f"baked.<UDIM>{suffix(channel)}"))
        for index in range(1, len(contents)):
            image.tiles.new(FIRST_TILE + index)
        image.reload()
        image.pack()
    return image
