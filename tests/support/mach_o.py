"""What a macOS library says of itself: the commands of its header (Apple, <mach-o/loader.h>) and its signature."""

import hashlib
import struct
from dataclasses import dataclass, field

MAGIC_64 = 0xFEEDFACF
PROCESSORS = {0x0100000C: "arm64", 0x01000007: "x86_64"}
LOAD_DYLIBS = (0x0C, 0x80000018, 0x8000001F)  # plain, weak, exported again
CODE_SIGNATURE, BUILD_VERSION, VERSION_MIN_MACOS = 0x1D, 0x32, 0x24
EMBEDDED_SIGNATURE, CODE_DIRECTORY = 0xFADE0CC0, 0xFADE0C02
SHA256 = 2  # as the type of hash in a code directory


@dataclass
class Library:
    """A 64-bit library: its processor, the libraries it asks for, the oldest macOS, and the bytes of its signature."""

    processor: str
    needed: set = field(default_factory=set)
    oldest: tuple = ()
    signature: bytes = b""


def read(data):
    magic, processor, _, _, commands, *_ = struct.unpack_from("<8I", data)
    assert magic == MAGIC_64
    library = Library(PROCESSORS[processor])
    at = 32
    for _ in range(commands):
        command, size = struct.unpack_from("<2I", data, at)
        if command in LOAD_DYLIBS:
            name = at + struct.unpack_from("<I", data, at + 8)[0]
            library.needed.add(data[name : at + size].split(b"\0")[0].decode())
        elif command in (BUILD_VERSION, VERSION_MIN_MACOS):
            version = struct.unpack_from("<I", data, at + (12 if command == BUILD_VERSION else 8))[0]
            library.oldest = (version >> 16, version >> 8 & 255)
        elif command == CODE_SIGNATURE:
            begin, length = struct.unpack_from("<2I", data, at + 8)
            library.signature = data[begin : begin + length]
        at += size
    return library


def wrong_pages(data, signature):
    """(number of pages whose hash is not that of the signature, number of pages)."""
    magic, _, blobs = struct.unpack_from(">3I", signature)
    assert magic == EMBEDDED_SIGNATURE
    begins = [struct.unpack_from(">2I", signature, 12 + 8 * i)[1] for i in range(blobs)]
    begin = next(b for b in begins if struct.unpack_from(">I", signature, b)[0] == CODE_DIRECTORY)
    directory = signature[begin:]
    hashes, _, _, pages, limit = struct.unpack_from(">5I", directory, 16)
    size, kind, _, log_page = struct.unpack_from(">4B", directory, 36)
    assert kind == SHA256
    page = 1 << log_page
    right = [directory[hashes + size * i : hashes + size * (i + 1)] for i in range(pages)]
    found = [hashlib.sha256(data[i * page : min((i + 1) * page, limit)]).digest()[:size] for i in range(pages)]
    return sum(a != b for a, b in zip(right, found)), pages
