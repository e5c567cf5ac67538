"""What the values of a picture mean as heights, for whatever reads its file."""

import struct

import numpy as np

MOST_PIXELS = 2**24
RED, BLUE = 0.2126, 0.0722  # what they count in the brightness, as Rec. 709 has it; green counts the rest
ROWS = 256  # of a picture, at a time
ORIENTATION = 0x0112  # the tag of EXIF


class Unread(ValueError):
    """A picture that is whole, and is not read; the text is one sentence."""


def check_size(name, width, height):
    """@throws Unread where a picture has more pixels than are read"""
    if width * height > MOST_PIXELS:
        raise Unread(f"{name} has {width} x {height} pixels, {too_many()}")


def too_many():
    """The end of a sentence about a picture."""
    side = int(MOST_PIXELS**0.5)
    return f"more than the {MOST_PIXELS:,} that are read, such as {side} x {side}: make it smaller"


def brightness(red, green, blue):
    """(rows, columns) float64: the heights of colours, exactly those of each channel where all are alike."""
    found = np.array(green, np.float64)
    for first in range(0, len(found), ROWS):  # so that little is there twice
        rows = slice(first, first + ROWS)
        middle = found[rows].copy()
        found[rows] += RED * (red[rows] - middle) + BLUE * (blue[rows] - middle)
    return found


def upright(values, orientation):
    """(rows, columns, ...) values, turned as an EXIF orientation from 1 to 8 says; as they are for others."""
    if orientation not in range(2, 9):
        return values
    if orientation >= 5:
        values = values.swapaxes(0, 1)
    if orientation in (3, 4, 7, 8):
        values = values[::-1]
    return values[:, ::-1] if orientation in (2, 3, 6, 7) else values


def orientation(content):
    """The EXIF orientation in the first bytes of a JPEG or PNG file; 1 where there is none."""
    mark = {b"\xff\xd8": b"Exif\0\0", b"\x89P": b"eXIf"}.get(content[:2], b"")
    place = content.find(mark) + len(mark) if mark in content else len(content)
    data = content[place:]
    order = {b"II*\0": "<", b"MM\0*": ">"}.get(data[:4])
    if not mark or order is None:
        return 1
    try:
        (first,) = struct.unpack_from(f"{order}I", data, 4)
        (count,) = struct.unpack_from(f"{order}H", data, first)
        entries = [struct.unpack_from(f"{order}HHIH", data, first + 2 + 12 * k) for k in range(count)]
    except struct.error:  # cut off
        return 1
    return next((value for tag, _, _, value in entries if tag == ORIENTATION), 1)
