"""PNG files of few colours, by NumPy alone."""

import struct
import zlib

import numpy as np


def encoded(image, palette, alpha=b""):
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
