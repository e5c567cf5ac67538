# SPDX-License-Identifier: GPL-3.0-or-later
"""Letters, digits and an arrow as small bitmaps, for tiles that tell where they lie. Arrays only, no bpy."""

import numpy as np

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
