"""A checker that suits a map: how many squares, and a picture of them that tiles."""

import numpy as np

from . import indexed_png

COLOURS = ((244, 240, 232), (214, 110, 50))  # sRGB
ACROSS = 32  # squares along the diagonal of the bounding box, about, at the median density
MOST_SQUARES = 10_000  # per UV unit
SIDE = 2048  # pixels of an image, about: a whole number of them for each square
MOST_SQUARES_OF_IMAGE = SIDE // 8  # for each to have pixels enough


def squares(surface, uv, is_mapped):
    """Squares per UV unit, an even number, so that whole units change nothing.

    uv : (#C, 2); is_mapped : (#T,) bool, triangles that count
    """
    if not is_mapped.any():
        return 2
    corners, values = surface.vertices[surface.triangles[is_mapped]], uv[surface.triangle_corners[is_mapped]]
    sides, sides_uv = np.diff(corners, axis=1), np.diff(values, axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    area_uv = np.abs(sides_uv[:, 0, 0] * sides_uv[:, 1, 1] - sides_uv[:, 0, 1] * sides_uv[:, 1, 0])
    density = np.median(area_uv[area > 0] / area[area > 0]) if area.any() else 0.0
    diagonal = np.linalg.norm(np.ptp(surface.vertices, axis=0))
    if not (density > 0 and diagonal > 0):
        return 2
    return int(min(max(2 * round(ACROSS / (diagonal * np.sqrt(density)) / 2), 2), MOST_SQUARES))


def png(surface, uv):
    """The picture of one UV unit, a PNG file. Triangles whose corners have one UV have no map, and do not count."""
    has_extent = np.ptp(uv[surface.triangle_corners], axis=1).any(axis=1)
    count = min(squares(surface, uv, has_extent), MOST_SQUARES_OF_IMAGE)
    place = np.arange(count * (SIDE // count)) // (SIDE // count)
    image = ((place[::-1, None] + place) % 2).astype(np.uint8)
    return indexed_png.encoded(image, np.array(COLOURS, np.uint8))
