# SPDX-License-Identifier: GPL-3.0-or-later
"""Periodic functions on the unit square, which images that tile are made of. Arrays only, no bpy.

Values are taken at the middles of pixels; x = u to the right, y = v upwards, row 0 at the bottom as Blender has it.
Same pixels at every call: random numbers have fixed seeds.
"""

import numpy as np


def grid(size):
    """x and y of the pixels' middles, (1, size) and (size, 1)."""
    middles = (np.arange(size) + 0.5) / size
    return middles[None, :], middles[:, None]


def noise(size, seed, across=4.0, along=4.0, power=3.0, parity=0):
    """(size, size) noise of mean 0 and deviation 1; from `across` waves per side in u and `along` in v on its spectrum
    falls with `power`. A half turn about the corner leaves it as it is where `parity` is 1, changes its sign where it
    is -1."""
    white = np.fft.rfft2(np.random.default_rng(seed).standard_normal((size, size)))
    u, v = np.fft.rfftfreq(size, 1 / size)[None, :], np.fft.fftfreq(size, 1 / size)[:, None]
    white *= (1 + (u / across) ** 2 + (v / along) ** 2) ** (-power / 2)
    white[0, 0] = 0
    waves = np.fft.irfft2(white, s=(size, size))
    if parity:
        waves = waves + parity * waves[::-1, ::-1]
    return waves / waves.std()


def chance(seed, *shape):
    """Random numbers from 0 to 1, one for each cell of a pattern."""
    return np.random.default_rng(seed).random(shape)


def mirrored(values):
    """The same with the first half of the rows again, backwards, as the second: those of an even number."""
    half = values[: len(values) // 2]
    return np.concatenate([half, half[::-1]])


def paired(seed, *shape):
    """Random numbers for cells of which a half turn takes each to the one with the opposite index: both have one."""
    return mirrored(chance(seed, *shape).ravel()).reshape(shape)


def smoothstep(low, high, x):
    """0 below `low`, 1 above `high`, smooth between."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def mix(first, second, share):
    """Colours between two, (..., 3), by an array of shares."""
    return np.asarray(first) + (np.asarray(second) - np.asarray(first)) * share[..., None]


def shade(colour, factor):
    """Colours times an array of factors."""
    return colour * factor[..., None]


WIDTH, HEIGHT = 5, 7
INK = 0.4  # interpolated values above it are ink; at 0.5 strokes along a diagonal would only touch
ROWS = {  # from the top down, "#" is ink
    "A": ".###. #...# #...# ##### #...# #...# #...#",
    "B": "####. #...# #...# ####. #...# #...# ####.",
    "C": ".###. #...# #.... #.... #.... #...# .###.",
    "D": "####. #...# #...# #...# #...# #...# ####.",
    "E": "##### #.... #.... ####. #.... #.... #####",
    "F": "##### #.... #.... ####. #.... #.... #....",
    "G": ".###. #...# #.... #.### #...# #...# .###.",
    "H": "#...# #...# #...# ##### #...# #...# #...#",
    "1": "..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###.",
    "2": ".###. #...# ....# ..##. .#... #.... #####",
    "3": ".###. #...# ....# ..##. ....# #...# .###.",
    "4": "...#. ..##. .#.#. #..#. ##### ...#. ...#.",
    "5": "##### #.... ####. ....# ....# #...# .###.",
    "6": "..##. .#... #.... ####. #...# #...# .###.",
    "7": "##### ....# ...#. ..#.. ..#.. ..#.. ..#..",
    "8": ".###. #...# #...# .###. #...# #...# .###.",
    "up": "..#.. .###. ##### ..#.. ..#.. ..#.. ..#..",
}


def bitmap(name):
    """(HEIGHT, WIDTH) of 0 and 1, the lowest row first."""
    return np.array([[mark == "#" for mark in row] for row in ROWS[name].split()], np.float64)[::-1]


def ink(name, height):
    """(height, ~) how much of each pixel is ink, from 0 to 1: the bitmap at this height, its corners rounded."""
    marks = np.pad(bitmap(name), 1)
    scale = height / HEIGHT
    rows, columns = (_between(count + 2, round(count * scale)) for count in (HEIGHT, WIDTH))
    smooth = rows @ marks @ columns.T
    return np.clip((smooth - INK) * scale + 0.5, 0, 1)


def _between(count, pixels):
    """(pixels, count): weights of linear interpolation from the middles of `count` cells, the outer two of which lie
    beyond the pixels."""
    at = 0.5 + (np.arange(pixels) + 0.5) * (count - 2) / pixels
    return np.clip(1 - np.abs(at[:, None] - np.arange(count)[None, :]), 0, None)
