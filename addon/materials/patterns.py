# SPDX-License-Identifier: GPL-3.0-or-later
"""The patterns of the textures, each on one unit square of UV space and seamless at its borders. Arrays only, no bpy.

Every formula has period 1 in u and in v. Colours are linear RGB; heights go from 0 to 1. What is on both sides of a
joint may look the same after a half turn: then all of the picture does, also its noise, about the corner of the square.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from . import periodic
from .periodic import chance, grid, mirrored, mix, noise, paired, shade, smoothstep

SIZE = 1024  # pixels across an image
CELLS = 8  # numbered tiles across


@dataclass(frozen=True, eq=False)
class Pattern:
    """What is seen at each pixel."""

    colour: np.ndarray  # (n, n, 3)
    height: np.ndarray | None = None  # (n, n); None where it is flat


def numbered(size):
    """Tiles A1 to H8: the letter is the column, the digit the row, the arrow points up. The hue turns once from left to
    right, the lightness climbs from the bottom to the top; no tile is like another one, turned or mirrored or not."""
    x, y = grid(size)
    column, row = np.broadcast_arrays((x * CELLS).astype(int), (y * CELLS).astype(int))
    ground = _tile_colours()[row, column]
    pixels = size // CELLS
    signs = np.block([[_sign(f"{c}{r}", pixels) for c in "ABCDEFGH"] for r in range(1, CELLS + 1)])
    edge = np.minimum(*(np.minimum(t, 1 - t) for t in ((x * CELLS) % 1, (y * CELLS) % 1)))
    is_dark = ground @ (0.2126, 0.7152, 0.0722) < 0.24
    ink = np.where(is_dark[..., None], (0.93, 0.91, 0.86), (0.025, 0.03, 0.04))
    colour = ground + (ink - ground) * signs[..., None]
    return Pattern(mix((0.9, 0.88, 0.84), colour, smoothstep(0.012, 0.024, edge)))


def _tile_colours():
    """(row, column, RGB) colours of the tiles."""
    hue = 2 * np.pi * np.arange(CELLS) / CELLS
    wheel = 0.5 + 0.5 * np.cos(hue[:, None] - np.array([0, 2, 4]) * np.pi / 3)
    tint = 0.12 + 0.75 * wheel**1.3
    light = np.linspace(0, 1, CELLS)[:, None, None]
    return tint[None] * (0.22 + 0.6 * light) + 0.16 * light**2


def _sign(name, pixels):
    """(pixels, pixels) ink of a letter, a digit and an arrow on one tile."""
    tile = np.zeros((pixels, pixels))
    for glyph, height, x, y in ((name[0], 0.42, 0.09, 0.29), (name[1], 0.42, 0.43, 0.29), ("up", 0.24, 0.77, 0.47)):
        mark = periodic.ink(glyph, round(height * pixels))
        column, row = round(x * pixels), round(y * pixels)
        tile[row : row + mark.shape[0], column : column + mark.shape[1]] = mark
    return tile


def bricks(size):
    """A running bond of four bricks by eight courses, in lime mortar."""
    across, along, joint = 4, 8, 0.055
    wobble = 0.012 * noise(size, 11, 12, 12, parity=-1)
    x, y = grid(size)
    y = y * along + wobble
    row = np.floor(y).astype(int) % along
    x = x * across + row / 2 + 0.25 + 0.5 * wobble.T
    column = np.floor(x).astype(int) % across
    edge = np.minimum(2 * np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1))
    edge = edge + 0.008 * noise(size, 12, 30, 30, 2, parity=1)
    brick = smoothstep(joint, joint + 0.06, edge)
    grain = noise(size, 13, 20, 20, 1.6, parity=1)
    pits = smoothstep(1.7, 2.6, noise(size, 14, 90, 90, 2, parity=1))
    tint, tone = paired(15, along, across)[row, column], paired(235, along, across)[row, column]
    clay = mix(mix((0.32, 0.085, 0.045), (0.48, 0.16, 0.075), tint), (0.15, 0.05, 0.04), smoothstep(0.78, 1.0, tone))
    clay = shade(clay, (1 + 0.10 * grain + 0.05 * noise(size, 17, 4, 4, parity=1)) * (1 - 0.5 * pits))
    mortar = shade(np.full((size, size, 3), (0.50, 0.46, 0.39)), 0.9 + 0.06 * grain - 0.25 * smoothstep(0, joint, edge))
    dome = smoothstep(joint - 0.01, 0.3, edge)
    height = 0.15 + 0.02 * grain + brick * (0.55 + 0.18 * dome + 0.1 * (tint - 0.5) - 0.12 * pits + 0.01 * grain)
    return Pattern(mix(mortar, clay, brick), height)


def scales(size):
    """Four scales by eight rows, tips downwards, each row over the one below it."""
    across, rows, radius = 4, 8, 0.66
    x, y = grid(size)
    x, y = np.broadcast_arrays(x * across, y * across)
    depth, at, angle = np.full((size, size), -1.0), np.zeros((size, size), int), np.zeros((size, size))
    nearest = np.floor(2 * y).astype(int)
    for step in (0, 1, 2):  # the highest of the rows that cover a point is seen
        row = nearest + step
        dx = (x - row / 2 + 0.5) % 1 - 0.5
        dy = y - row / 2
        inside = radius - np.hypot(dx * 1.22, dy) - 0.10 * np.abs(dx)
        covers = inside > 0
        depth, angle = np.where(covers, inside / radius, depth), np.where(covers, dx, angle)
        at = np.where(covers, _cell(x - dx, row, across, rows), at)
    tint = chance(21, rows * across)[at]
    grain = noise(size, 22, 15, 30, 2)
    ridge = np.exp(-((angle / 0.035) ** 2))
    body = mix(mix((0.012, 0.085, 0.075), (0.03, 0.17, 0.12), tint), (0.20, 0.30, 0.09), smoothstep(0.45, 0.0, depth))
    body = mix(body, (0.55, 0.47, 0.17), 0.85 * smoothstep(0.14, 0.03, depth))
    shadow = 1 - 0.75 * smoothstep(0.42, 0.75, depth)
    colour = shade(body, shadow * (1 + 0.07 * grain + 0.10 * ridge))
    height = 0.95 * (1 - depth) * smoothstep(0, 0.05, depth) + 0.05 * ridge + 0.006 * grain
    return Pattern(colour, np.clip(height, 0, 1))


def weave(size):
    """Plain weave of sixteen threads each way, light over dark."""
    count = 16
    x, y = grid(size)
    wobble = 0.025 * noise(size, 31, 10, 10, parity=-1)
    warp, weft = x * count + 0.5 + wobble, y * count + 0.5 + wobble.T  # a crossing lies at the corner
    is_over = (np.floor(warp) + np.floor(weft)) % 2 == 0  # the thread along u
    across_u, across_v = 2 * (weft % 1) - 1, 2 * (warp % 1) - 1
    side = np.where(is_over, across_u, across_v)
    run = np.where(is_over, across_v, across_u)
    round_, crown = np.sqrt(np.clip(1 - (side / 0.98) ** 2, 0, 1)), np.cos(np.pi / 2 * run)
    along_u, along_v = noise(size, 32, 3, 200, 2, parity=1), noise(size, 33, 200, 3, 2, parity=1)
    twist = np.where(is_over, along_u, along_v)
    thread = np.where(is_over, np.floor(weft) % count, np.floor(warp) % count).astype(int)
    thread = np.minimum(thread, count - thread)  # opposite ones have one colour
    tint = np.where(is_over, chance(34, count)[thread], chance(35, count)[thread])
    light = mix((0.62, 0.56, 0.44), (0.74, 0.69, 0.58), tint)
    dark = mix((0.035, 0.10, 0.16), (0.06, 0.15, 0.22), tint)
    lit = (0.35 + 0.65 * round_) * (0.55 + 0.45 * crown) * (1 + 0.10 * twist)
    height = np.clip(0.15 + round_ * (0.25 + 0.5 * crown) + 0.03 * twist, 0, 1)
    return Pattern(shade(np.where(is_over[..., None], light, dark), lit), height)


def planks(size):
    """Eight boards, each broken once, of oak."""
    boards = 8
    x, y = grid(size)
    row = (y * boards).astype(int)
    way = np.where(np.arange(boards) < boards // 2, 1, -1)  # of a half turn, which takes each board to another one
    start = (way * mirrored(np.arange(boards) * 0.381966 + 0.1 * chance(41, boards))) % 1
    x, y = np.broadcast_arrays((x - start[row]) % 1, (y * boards) % 1)
    row = np.broadcast_to(row, x.shape)
    gap = np.minimum(np.minimum(x, 1 - x) * boards, np.minimum(y, 1 - y))
    pick = mirrored(chance(42, boards, 2))
    bend, fine = noise(size, 43, 2.2, 9, 3, parity=-1), noise(size, 44, 8, 260, 2, parity=1)
    pores = smoothstep(1.1, 2.2, noise(size, 45, 14, 330, 3, parity=1))
    shift = way * (pick[:, 0] * size).astype(int)
    lines = np.arange(size)
    bend = bend[(lines[:, None] + shift[row]) % size, lines[None, :]]
    rings = 0.5 + 0.5 * np.cos(2 * np.pi * (3.2 * (y - 0.5 + (way * pick[:, 1])[row]) + 0.9 * bend))
    wood = mix((0.40, 0.20, 0.085), (0.24, 0.105, 0.04), rings**2)
    wood = shade(wood, (0.72 + 0.5 * pick[row, 1]) * (1 + 0.07 * fine) * (1 - 0.45 * pores))
    board = smoothstep(0.012, 0.045, gap)
    height = board * (0.8 + 0.12 * smoothstep(0.02, 0.12, gap) - 0.05 * rings - 0.06 * pores + 0.01 * fine)
    return Pattern(mix((0.02, 0.011, 0.006), wood, board), np.clip(height, 0, 1))


def hexagons(size):
    """Seven glazed tiles by eight rows; they are regular up to one per cent, as a unit square allows."""
    across, rows = 7, 8
    x, y = grid(size)
    x, y = np.broadcast_arrays(x * across, y * rows)
    near, at = np.full((size, size), np.inf), np.zeros((size, size), int)
    edge = np.zeros((size, size))
    lattice = np.sqrt(0.75)
    for step in (0, 1):
        row = np.floor(y).astype(int) + step
        dx = (x - row / 2 + 0.5) % 1 - 0.5
        dy = (y - row) * lattice
        distance = np.hypot(dx, dy)
        inside = 0.5 - np.maximum(np.abs(dx), 0.5 * np.abs(dx) + lattice * np.abs(dy))
        is_nearer = distance < near
        near, edge = np.where(is_nearer, distance, near), np.where(is_nearer, inside, edge)
        at = np.where(is_nearer, _cell(x - dx, row, across, rows), at)
    cells = np.arange(rows * across)
    opposite = _cell(-(cells % across) - cells // across / 2, -(cells // across), across, rows)
    at = np.minimum(at, opposite[at])  # both have one colour
    tint, kind = chance(51, rows * across)[at], chance(52, rows * across)[at]
    cloud = noise(size, 53, 12, 12, parity=1)
    glaze = mix((0.03, 0.13, 0.17), (0.05, 0.21, 0.24), tint)
    glaze = np.where((kind > 0.72)[..., None], mix((0.55, 0.50, 0.41), (0.68, 0.63, 0.53), tint), glaze)
    glaze = np.where((kind > 0.92)[..., None], mix((0.50, 0.22, 0.05), (0.60, 0.28, 0.07), tint), glaze)
    glaze = shade(glaze, (1 + 0.07 * cloud) * (1 - 0.3 * smoothstep(0.10, 0.02, edge)))
    tile = smoothstep(0.024, 0.04, edge)
    grout = shade(np.full((size, size, 3), (0.42, 0.41, 0.38)), 0.9 + 0.06 * noise(size, 54, 200, 200, 1, parity=1))
    height = 0.2 + tile * (0.45 + 0.3 * smoothstep(0.02, 0.14, edge) + 0.02 * cloud)
    return Pattern(mix(grout, glaze, tile), height)


def _cell(middle, row, across, rows):
    """The index of a cell in rows that are shifted by half a cell each; `rows` is even."""
    row = row % rows
    return row * across + np.round(middle - row / 2).astype(int) % across


class Texture(NamedTuple):
    """A pattern and what its material needs."""

    draw: object  # from the size in pixels to a `Pattern`
    cells: int  # things that are counted across: tiles, bricks, scales
    roughness: float = 0.5
    relief: float = 0.0  # greatest height, in sides of the unit square
    across: int = 16  # cells that span an object where no number is asked for: fewer the more there is to see in one
    turns: int = 1  # 2 or 4: it looks the same after a half or a quarter turn about the corner of the square


TEXTURES = {
    "NUMBERED": Texture(numbered, CELLS, 0.6),
    "BRICKS": Texture(bricks, 4, 0.85, 0.012, turns=2),
    "SCALES": Texture(scales, 4, 0.35, 0.04),
    "WEAVE": Texture(weave, 16, 0.9, 0.010, 64, turns=4),
    "PLANKS": Texture(planks, 8, 0.55, 0.006, turns=2),
    "HEXAGONS": Texture(hexagons, 7, 0.18, 0.006, turns=2),
}
