# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of Blender's images."""

from contextlib import ExitStack

import bpy
import numpy as np

from ..native import holomorph

EXIF_BYTES = 2**18


def read_pixels(image):
    """(height, width, channels) float32, the lowest row first, in the image's own colour space; no rows of an image
    whose file is not there."""
    width, height = image.size
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, -1) if len(values) else np.empty((0, 0, 4), np.float32)


def read_file_values(image):
    """`read_pixels` of the values in the image's file, turned as its EXIF data say, not as they are converted for
    rendering: 16 bits and reals in sRGB are, and colours are multiplied by alpha. What was painted or generated has no
    file. @throws ValueError where it is too large"""
    reader = holomorph.files.picture_values
    reader.check_size(image.name, *image.size)
    if image.source != "FILE" or image.is_dirty:
        return read_pixels(image)
    made = []
    with ExitStack() as last_first:
        last_first.callback(bpy.data.batch_remove, made)
        made.append(image.copy())
        made[0].colorspace_settings.name = "Non-Color"
        made[0].alpha_mode = "CHANNEL_PACKED"
        pixels = read_pixels(made[0])
    return reader.upright(pixels[::-1], reader.orientation(_file_start(image)))[::-1]


def _file_start(image):
    """The first bytes of the file, in which EXIF data are."""
    if image.packed_file is not None:
        return image.packed_file.data[:EXIF_BYTES]
    try:
        with open(bpy.path.abspath(image.filepath, library=image.library), "rb") as file:
            return file.read(EXIF_BYTES)
    except OSError:
        return b""


def write_pixels(image, pixels):
    """Writes (height, width, 4) float32, the lowest row first, in the image's own colour space."""
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
