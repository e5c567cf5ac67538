"""A small picture of a mesh with a checker, drawn by NumPy alone: a z-buffer filled span by span."""

import numpy as np

from ..files import textures

SIZE = 192  # pixels of a side; pages show it smaller, which smooths it
MARGIN = 6.0  # pixels
VIEW = np.array([0.55, 0.35, 1.0])  # from where one looks, y up
LIGHT = np.array([0.2, 0.45, 1.0])  # in the frame of the picture: right, up, towards the viewer
SHADES = 64
AMBIENT = 0.35  # the darkest shade
COLOURS = np.array([*textures.COLOURS, (150, 150, 158)])  # what has no map is grey
BACKGROUND = SHADES * len(COLOURS)  # in the palette, transparent
DEPTHS = 2**30  # steps of the z-buffer


def png(surface, uv, is_mapped, up, is_turned=False):
    """The picture as an indexed PNG file.

    uv : (#C, 2); is_mapped : (#T,) bool, triangles that the checker covers; up : "Y" or "Z"
    is_turned : the map turns about whole UVs, at which the middle of a square then lies
    """
    points, triangles = _projected(surface.vertices, up), surface.triangles
    corners, texture = points[triangles], uv[surface.triangle_corners]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    seen = np.flatnonzero(normals[:, 2] != 0)
    planes = _planes(corners[seen], texture[seen], normals[seen])
    image = np.full(SIZE * SIZE, BACKGROUND, np.uint8)
    pixels, winners = _visible(corners[seen], planes)
    if len(pixels):
        count = textures.squares(surface, uv, is_mapped)
        u, v = (_at(planes[winners, axis], pixels) * count + 0.5 * is_turned for axis in (1, 2))
        colour = ((np.floor(u) + np.floor(v)) % 2).astype(np.uint8)
        colour[~is_mapped[seen[winners]]] = 2
        image[pixels] = colour * SHADES + _shades(normals[seen[winners]])
    return _encoded(image.reshape(SIZE, SIZE)[::-1])


def _projected(vertices, up):
    """(#V, 3): pixels to the right, pixels upwards, and towards the viewer, from 0 to SIZE."""
    points = vertices if up == "Y" else vertices[:, [1, 2, 0]]
    towards = VIEW / np.linalg.norm(VIEW)
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    seen = points @ np.array([right, np.cross(towards, right), towards]).T
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = (SIZE - 2 * MARGIN) / max((high - low)[:2].max(), np.finfo(float).tiny)
    return (seen - (low + high) / 2) * scale + SIZE / 2


def _planes(corners, texture, normals):
    """(#T, 3, 3): depth, u and v of each triangle as a + b x + c y of the pixel."""
    values = np.concatenate([corners[:, :, 2:], texture], axis=2)
    first, second = values[:, 1] - values[:, 0], values[:, 2] - values[:, 0]
    a, b = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    area = normals[:, 2:]
    along_x = (first * b[:, 1:] - second * a[:, 1:]) / area
    along_y = (second * a[:, :1] - first * b[:, :1]) / area
    origin = values[:, 0] - along_x * corners[:, 0, :1] - along_y * corners[:, 0, 1:2]
    return np.stack([origin, along_x, along_y], axis=2)


def _at(plane, pixels):
    """Values of planes, (n, 3), in the middle of pixels."""
    x, y = pixels % SIZE + 0.5, pixels // SIZE + 0.5
    return plane[:, 0] + plane[:, 1] * x + plane[:, 2] * y


def _visible(corners, planes):
    """The pixels that are covered, and the triangle that is seen in each."""
    pixels, triangles = _spans(corners)
    depth = _at(planes[triangles, 0], pixels)
    steps = np.clip(depth * (DEPTHS / (2.0 * SIZE)) + DEPTHS / 2, 0, 2 * DEPTHS).astype(np.int64)
    nearest = np.full(SIZE * SIZE, -1, np.int64)
    np.maximum.at(nearest, pixels, steps << 31 | triangles)
    covered = np.flatnonzero(nearest >= 0)
    return covered, nearest[covered] & (2**31 - 1)


def _spans(corners):
    """(pixel, triangle) for each pixel whose middle a triangle covers."""
    y = corners[:, :, 1]
    row, triangle = _ranges(y.min(axis=1), y.max(axis=1))
    start, end = corners[triangle][:, :, :2], corners[triangle][:, [1, 2, 0], :2]
    height = row[:, None] + 0.5
    rise = end[:, :, 1] - start[:, :, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (height - start[:, :, 1]) / rise
        crossing = start[:, :, 0] + share * (end[:, :, 0] - start[:, :, 0])
    is_crossed = (share >= 0) & (share <= 1) & (rise != 0)
    left = np.where(is_crossed, crossing, np.inf).min(axis=1)
    right = np.where(is_crossed, crossing, -np.inf).max(axis=1)
    column, span = _ranges(left, right)
    return row[span] * SIZE + column, triangle[span]


def _ranges(low, high):
    """The pixels whose middles lie between bounds, and which bounds they are."""
    first = np.ceil(np.clip(low, 0, SIZE) - 0.5).astype(np.int64)
    last = np.floor(np.clip(high, 0, SIZE) - 0.5).astype(np.int64)
    first, last = np.maximum(first, 0), np.minimum(last, SIZE - 1)
    count = np.maximum(last - first + 1, 0)
    owner = np.repeat(np.arange(len(count)), count)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    return first[owner] + within, owner


def _shades(normals):
    """The brightness of each triangle; both sides are lit alike."""
    light = LIGHT / np.linalg.norm(LIGHT)
    facing = normals * np.sign(normals[:, 2:])
    lit = np.maximum(facing @ light, 0.0) / np.linalg.norm(normals, axis=1)
    return (lit * (SHADES - 1)).astype(np.uint8)


def _encoded(image):
    shades = AMBIENT + (1 - AMBIENT) * np.arange(SHADES) / (SHADES - 1)
    lit = (COLOURS[:, None, :] * shades[None, :, None]).astype(np.uint8).reshape(-1, 3)
    palette = np.append(lit, np.zeros((1, 3), np.uint8), axis=0)
    return textures.indexed_png(image, palette, b"\xff" * BACKGROUND + b"\0")
