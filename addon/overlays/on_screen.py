# SPDX-License-Identifier: GPL-3.0-or-later
"""Rectangles and words over a view, in pixels of its region. Called from draw handlers only."""

import blf
import gpu
from gpu_extras.batch import batch_for_shader

FONT, TEXT_SIZE = 0, 12
TEXT_COLOUR = (0.95, 0.95, 0.95, 1.0)
BACKGROUND = (0.0, 0.0, 0.0, 0.55)


def rectangle(left, low, width, height, colours):
    """Draws a rectangle with one colour at its left edge and one at its right."""
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    points = [(left, low, 0), (left, low + height, 0), (left + width, low, 0), (left + width, low + height, 0)]
    first, second = colours
    corners = {"pos": points, "color": [first, first, second, second]}
    batch_for_shader(shader, "TRI_STRIP", corners).draw(shader)


def text(words, middle, low, unit):
    text_from(words, middle - text_width(words, unit) / 2, low, unit)


def text_from(words, left, low, unit):
    blf.size(FONT, TEXT_SIZE * unit)
    blf.color(FONT, *TEXT_COLOUR)
    blf.position(FONT, left, low, 0)
    blf.draw(FONT, words)


def text_width(words, unit):
    blf.size(FONT, TEXT_SIZE * unit)
    return blf.dimensions(FONT, words)[0]
