"""Pictures of heights from files: the values that are in the file, whatever colour space it is said to be in."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from pathlib import Path

import numpy as np

from ..core.array_types import FilePath, Reals
from ..core.arrays import frozen
from ..files import whole_file
from ..files.picture_values import ORIENTATION, Unread, brightness, check_size, too_many, upright

FORMATS = ("PNG", "JPEG", "TIFF", "WEBP", "BMP")  # others start programs, or are read by no one else
MOST_BYTES = 2**28
WHITE = {"I;16": 2**16 - 1, "I;16B": 2**16 - 1, "I;16L": 2**16 - 1, "I": 2**16 - 1, "F": 1}  # others: 8 bits
DAMAGED = (SyntaxError, OSError, ValueError, TypeError, KeyError, IndexError, OverflowError, struct.error, EOFError)
BITS_PER_SAMPLE = 258  # the tag of TIFF
DEPTH_AND_KIND = slice(24, 26)  # of a PNG file: bits of a channel, and which channels there are
HEADER, HEADER_SUM = slice(12, 29), slice(29, 33)
GREY_WITH_ALPHA, FOUR_CHANNELS = bytes([16, 4]), bytes([8, 6])


def height_image(path: FilePath) -> Reals:
    """(rows, columns) heights of a picture file, from 0 for black to 1 for white, the top row first, upright as its
    EXIF data say. It is PNG with 8 or 16 bits in each channel, JPEG, WebP, BMP, or TIFF with 8 bits, or 16 bits or
    reals of grey.
    The heights are the values in the file, of colours their brightness (Rec. 709); transparency is not looked at.

    Raises ValueError where it is not such a picture, has more than 2^24 pixels, or Pillow is not installed; OSError.
    Source: ITU-R BT.709 for the brightness of colours.

    Examples
    --------
    >>> print(holomorph.height_image("docs/pictures/tiling.jpg").shape)
    (366, 1464)
    """
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError as error:
        raise ValueError(
            "reading pictures needs Pillow, which is not installed: pip install holomorph[relief]"
        ) from error
    name = Path(path).name
    content = whole_file.read(path, MOST_BYTES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what is damaged is refused, and what is large as well
        try:
            return frozen(_read(content, name, Image))
        except Unread:
            raise
        except Image.DecompressionBombError as error:
            raise ValueError(f"{name} has {too_many()}") from error
        except (UnidentifiedImageError, *DAMAGED) as error:
            raise ValueError(f"{name} is not a readable picture ({', '.join(FORMATS)})") from error


def _read(content, name, pillow):
    """(rows, columns) heights. @throws Unread, what Pillow raises"""
    with pillow.open(io.BytesIO(content), formats=FORMATS) as picture:
        check_size(name, *picture.size)
        _check_depth(picture, name)
        values = _values(picture, content, pillow)
        return upright(values, _orientation(picture))


def _orientation(picture):
    try:
        return picture.getexif().get(ORIENTATION, 1)
    except DAMAGED:
        return 1


def _check_depth(picture, name):
    """@throws Unread where Pillow would lose bits"""
    is_grey = picture.mode in (*WHITE, "1", "L")
    if picture.format == "TIFF" and not is_grey and max(picture.tag_v2.get(BITS_PER_SAMPLE, (8,))) > 8:
        raise Unread(f"{name} has colours or alpha of more than 8 bits, as TIFF: save it in grey alone, or as PNG")


def _values(picture, content, pillow):
    """(rows, columns) float64."""
    if picture.mode in WHITE:
        return np.asarray(picture, np.float64) / WHITE[picture.mode]
    if picture.format == "PNG" and content[DEPTH_AND_KIND][0] == 16:
        return _sixteen_bits(picture, content, pillow)
    grey = picture.getchannel("L") if picture.mode in ("L", "LA") else picture
    grey = grey.convert("L") if grey.mode == "1" else grey
    if grey.mode == "L":
        return np.asarray(grey, np.float64) / 255
    colours = picture.convert("RGB")
    return brightness(*(np.asarray(colours.getchannel(k)) for k in "RGB")) / 255


def _sixteen_bits(picture, content, pillow):
    """(rows, columns) of a PNG with alpha or colours, of which Pillow reads the higher bytes; here come the others."""
    if content[DEPTH_AND_KIND] == GREY_WITH_ALPHA:  # which has as many bytes as four channels of 8 bits
        begin, end = content[HEADER.start : DEPTH_AND_KIND.start], content[DEPTH_AND_KIND.stop : HEADER.stop]
        header = begin + FOUR_CHANNELS + end
        told = content[: HEADER.start] + header + struct.pack(">I", zlib.crc32(header)) + content[HEADER_SUM.stop :]
        with pillow.open(io.BytesIO(told), formats=["PNG"]) as channels:
            return _joined(*(channels.getchannel(k) for k in "RG")) / WHITE["I;16"]
    with pillow.open(io.BytesIO(content), formats=["PNG"]) as lower:
        lower.tile = [(*tile[:3], tile[3].replace(";16B", ";16L")) for tile in lower.tile]
        return brightness(*(_joined(picture.getchannel(k), lower.getchannel(k)) for k in "RGB")) / WHITE["I;16"]


def _joined(high, low):
    """(rows, columns) of the bytes of 16 bits."""
    return np.asarray(high, np.uint16) << 8 | np.asarray(low)
