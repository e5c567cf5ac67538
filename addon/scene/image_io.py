# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of Blender's images."""

import numpy as np


def read_pixels(image):
    """(height, width, channels) float32, the lowest row first, in the image's own colour space; no rows of an image
    whose file is not there."""
    width, height = image.size
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, -1) if len(values) else np.empty((0, 0, 4), np.float32)


def write_pixels(image, pixels):
    """Writes (height, width, 4) float32, the lowest row first, in the image's own colour space."""
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
