"""Textures of meshes in files: a picture of the user's, byte by byte, or a checker that is drawn for the map."""

import hashlib
from typing import NamedTuple

from . import checker, whole_file

CHECKER = "checker"
PNG, JPEG = "image/png", "image/jpeg"
SIGNATURES = {b"\x89PNG\r\n\x1a\n": PNG, b"\xff\xd8\xff": JPEG}  # what files begin with, whatever they are called


class Image(NamedTuple):
    """A picture as a file."""

    media_type: str
    content: bytes


def image(texture, surface, uv):
    """The `Image` for a map, (#C, 2). texture : `CHECKER` or a path. @throws ValueError, OSError as `read`"""
    return Image(PNG, checker.png(surface, uv)) if texture == CHECKER else read(texture)


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
