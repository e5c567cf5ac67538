# SPDX-License-Identifier: GPL-3.0-or-later
"""The images that materials show: packed into the file, made once in each."""

import functools

import bpy
import numpy as np

from ..scene import image_io
from .patterns import SIZE, TEXTURES

OURS = "holomorph_image"  # custom property that tells our images: what is on it
RELIEF = " relief"  # ends it where that are heights
CHECKER_SIZE = 256  # pixels, about: a whole number of them for each square
MOST_REPEATS = 32  # in a preview
GRID = 8  # the sides of drawings are multiples of it, for every pattern to have whole cells
STEPS = 255  # of a channel


def label(texture):
    return texture.title()


def colour_image(texture):
    """The picture of a texture."""
    return _image(f"Holomorph {label(texture)}", texture, lambda: _srgb(_drawn(texture).colour))


def relief_image(texture):
    """The heights of a texture, red + green / 255: a channel alone would have visible steps. None where it is flat."""
    if not TEXTURES[texture].relief:
        return None
    name = f"Holomorph {label(texture)} Relief"
    return _image(name, texture + RELIEF, lambda: _two_channels(_drawn(texture).height), "Non-Color")


def preview_image(texture, repeats):
    """A texture `repeats` times in a row, for views that stretch the image over the UV square."""
    if repeats == 1:
        return colour_image(texture)
    repeats = min(repeats, MOST_REPEATS)
    name = f"Holomorph {label(texture)} x{repeats}"
    return _image(name, f"{texture} {repeats}", lambda: _srgb(_repeated(texture, repeats)))


def checker_image(squares, light, dark, is_centred=False):
    """An even number of squares across, as near to `squares` as there is; and that number. Where it is centred, the
    middle of a square lies at the corner."""
    squares = min(max(2 * round(squares / 2), 2), CHECKER_SIZE // 2 if is_centred else CHECKER_SIZE)
    end = " centred" * is_centred
    drawn = functools.partial(_squares, squares, light, dark, is_centred)
    return _image(f"Holomorph Checker {squares}{end}", f"checker {squares}{end}", drawn), squares


def _squares(squares, light, dark, is_centred):
    width = CHECKER_SIZE // squares
    width -= width % 2 if is_centred else 0
    place = (np.arange(squares * width) + (width // 2 if is_centred else 0)) // width
    is_light = (place[:, None] + place[None, :]) % 2 == 0
    return _srgb(np.where(is_light[..., None], light, dark))


def _image(name, key, draw, colour_space="sRGB"):
    """The image with this key in the file; made where there is none."""
    found = next((i for i in bpy.data.images if i.get(OURS) == key and i.library is None), None)
    if found is not None:
        return found
    if key in _packed:
        image = bpy.data.images.new(name, 1, 1, alpha=False)
        image.colorspace_settings.name = colour_space
        image.pack(data=_packed[key], data_len=len(_packed[key]))
        image.source = "FILE"
    else:
        pixels = draw()
        image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=False)
        image.colorspace_settings.name = colour_space
        _fill(image, pixels)
        _packed[key] = image.packed_file.data
    image[OURS] = key
    return image


_packed = {}  # files of images by key: the redo panel undoes what it made before it makes it again


def _fill(image, pixels):
    opaque = np.ones((*pixels.shape[:2], 4), np.float32)
    opaque[..., :3] = pixels
    image_io.write_pixels(image, opaque)
    image.pack()


@functools.lru_cache(maxsize=2)
def _drawn(texture):
    return TEXTURES[texture].draw(SIZE)


def _repeated(texture, repeats):
    """Each pixel is the mean of `repeats` x `repeats` of a drawing."""
    side = GRID * (SIZE // (GRID * repeats))
    colour = TEXTURES[texture].draw(side * repeats).colour
    small = colour.reshape(side, repeats, side, repeats, 3).mean(axis=(1, 3))
    return np.tile(small, (repeats, repeats, 1))


def _two_channels(height):
    coarse = np.floor(np.clip(height, 0, 1) * STEPS) / STEPS
    fine = (np.clip(height, 0, 1) - coarse) * STEPS
    return np.stack([coarse, fine, np.zeros_like(height)], axis=-1)


def _srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
