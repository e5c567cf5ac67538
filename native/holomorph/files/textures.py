"""Textures of meshes in files: a picture of the user's, byte by byte, or a checker that is drawn for the map."""

import hashlib
import struct
import zlib
from typing import NamedTuple

import numpy as np

from . import whole_file

CHECKER = "checker"
PNG, JPEG = "image/png", "image/jpeg"
SIGNATURES = {b"\x89PNG\r\n\x1a\n": PNG, b"\xff\xd8\xff": JPEG}  # what files begin with, whatever they are called
COLOURS = ((244, 240, 232), (214, 110, 50))  # sRGB
ACROSS = 32  # squares along the diagonal of the bounding box, about, at the median density
MOST_SQUARES = 10_000  # per UV unit
SIDE = 2048  # pixels of an image, about: a whole number of them for each square
MOST_SQUARES_OF_IMAGE = SIDE // 8  # for each to have pixels enough


class Image(NamedTuple):
    """A picture as a file."""

    media_type: str
    content: bytes


def image(texture, surface, uv):
    """The `Image` for a map, (#C, 2). texture : `CHECKER` or a path. @throws ValueError, OSError as `read`"""
    return Image(PNG, _checker(surface, uv)) if texture == CHECKER else read(texture)


def check(texture):
    """@throws ValueError, OSError where `image` would"""
    if texture != CHECKER:
        read(texture)


def digest(texture):
    """Tells images apart by what is on them. @throws ValueError, OSError as `read`"""
    return CHECKER if texture == CHECKER else hashlib.sha256(read(texture).content).hexdigest()


def read(path):
    """The `Image` that a file holds. @throws ValueError for other files than PNG and JPEG, @throws OSError"""
    content = whole_file.read(path)
    for signature, media_type in SIGNATURES.items():
        if content.startswith(signature):
            return Image(media_type, content)
    raise ValueError(f"{path} is not a PNG or JPEG image, the only kinds that glTF files hold")


def squares(surface, uv, is_mapped):
    """Squares of a checker per UV unit, an even number, so that whole units change nothing.

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


def checker_squares(surface, uv):
    """Squares of the image of a checker, a side. Triangles whose corners have one UV have no map, and do not count."""
    has_extent = np.ptp(uv[surface.triangle_corners], axis=1).any(axis=1)
    return min(squares(surface, uv, has_extent), MOST_SQUARES_OF_IMAGE)


def _checker(surface, uv):
    """A checker in one UV unit, a PNG file."""
    count = checker_squares(surface, uv)
    place = np.arange(count * (SIDE // count)) // (SIDE // count)
    image = ((place[::-1, None] + place) % 2).astype(np.uint8)
    return indexed_png(image, np.array(COLOURS, np.uint8))


def indexed_png(image, palette, alpha=b""):
    """The bytes of a PNG file, the same for the same pixels.

    image : (h, w) uint8, indices of colours, the top row first; palette : (n, 3) uint8; alpha : of the first colours,
    the others are opaque
    """
    height, width = image.shape
    filtered = np.insert(image, 0, 0, axis=1).tobytes()  # each row begins with its filter, 0 for none
    chunks = [
        _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
        _chunk(b"PLTE", palette.tobytes()),
        _chunk(b"tRNS", alpha) if alpha else b"",
        _chunk(b"IDAT", zlib.compress(filtered, 6)),
        _chunk(b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def _chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
