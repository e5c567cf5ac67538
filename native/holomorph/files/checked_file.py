"""Files of progressive meshes: the bytes of the native core, and their CRC-32 at the end."""

import zlib

from .._native import InvalidMesh
from . import whole_file


def write(path, content):
    """Writes the content and its checksum, 4 bytes in little endian order."""
    whole_file.write(path, content, zlib.crc32(content).to_bytes(4, "little"))


def read(path):
    """The content without the checksum.

    Raises InvalidMesh if the checksum does not fit a content that begins as a progressive mesh: what else it may be is
    found when it is read. OSError"""
    whole = whole_file.read(path)
    content, checksum = whole[:-4], whole[-4:]
    if len(whole) >= 12 and zlib.crc32(content).to_bytes(4, "little") != checksum and content[:6] == b"HoloPM":
        raise InvalidMesh("the progressive mesh is damaged: its checksum does not match")
    return content
