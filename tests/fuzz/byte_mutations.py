"""Mutations of files, the same for the same seed on every machine.

Atheris, libFuzzer for Python, is led by the counters of coverage that Clang puts into native code; the core is compiled
by GCC, of whose counters libFuzzer knows none. Led by Python's lines alone, which hardly branch before the core is
entered, it is no better than chance and several times slower. So chance is used, with mutations that know what mesh
files are made of: numbers, lines and 4-byte words.
"""

import re
import struct

NUMBERS = [
    0,
    -1,
    1,
    2**31 - 1,
    2**31,
    2**32 - 1,
    2**63,
    float("nan"),
    float("inf"),
    1e308,
    -1e308,
    1e154,
    1e-320,
    1e-80,
]
TOKEN = re.compile(rb"[^\s/,]+")
LINE = re.compile(rb"[^\n]*\n")
FORMATS = ("<i", ">i", "<q", "<f", ">f", "<d", ">d")
MOST = 2**16  # bytes of a mutated file: what is wrong shows in small ones, which are quick


def packed(number, form):
    """As the bytes of a type, all of them 255 where it does not fit."""
    try:
        return struct.pack(form, number)
    except (struct.error, OverflowError):
        if form[1] in "iq":
            return b"\xff" * struct.calcsize(form)
        return struct.pack(form, float("inf"))


def bit_flipped(data, random):
    place, bit = random.randrange(len(data)), random.randrange(8)
    return data[:place] + bytes([data[place] ^ (1 << bit)]) + data[place + 1 :]


def byte_replaced(data, random):
    place = random.randrange(len(data))
    return data[:place] + bytes([random.randrange(256)]) + data[place + 1 :]


def header_replaced(data, random):
    place = random.randrange(min(len(data), 100))
    return data[:place] + bytes([random.randrange(256)]) + data[place + 1 :]


def truncated(data, random):
    return data[: random.randrange(len(data) + 1)]


def word_replaced(data, random):
    """A number of several bytes, at a multiple of two."""
    word = packed(random.choice(NUMBERS), random.choice(FORMATS))
    place = 2 * random.randrange(len(data) // 2 + 1)
    return data[:place] + word + data[place + len(word) :]


def _piece(data, random, pattern):
    """(start, end) of a random match, of all the data where there is none."""
    found = [match.span() for match in pattern.finditer(data)]
    return random.choice(found) if found else (0, len(data))


def number_swapped(data, random):
    start, end = _piece(data, random, TOKEN)
    return data[:start] + str(random.choice(NUMBERS)).encode() + data[end:]


def token_deleted(data, random):
    start, end = _piece(data, random, TOKEN)
    return data[:start] + data[end:]


def token_moved(data, random):
    """One token in the place of another."""
    start, end = _piece(data, random, TOKEN)
    first, last = _piece(data, random, TOKEN)
    return data[:start] + data[first:last] + data[end:]


def repeated(data, random):
    """A token or a line several times."""
    start, end = _piece(data, random, random.choice((TOKEN, LINE)))
    return data[:end] + (b" " + data[start:end]) * random.choice((1, 2, 9)) + data[end:]


def line_deleted(data, random):
    start, end = _piece(data, random, LINE)
    return data[:start] + data[end:]


def piece_deleted(data, random):
    start, end = sorted(random.randrange(len(data) + 1) for _ in range(2))
    return data[:start] + data[end:]


MUTATIONS = (
    bit_flipped,
    byte_replaced,
    header_replaced,
    truncated,
    word_replaced,
    number_swapped,
    token_deleted,
    token_moved,
    repeated,
    line_deleted,
    piece_deleted,
)


def spliced(one, other, random):
    """The beginning of one and the end of the other."""
    return one[: random.randrange(len(one) + 1)] + other[random.randrange(len(other) + 1) :]


def mutated(data, other, random):
    """`data` after a few mutations, mostly one or two; `other` is for splices."""
    if random.random() < 0.05:
        data = spliced(data, other, random)
    while data:
        data = random.choice(MUTATIONS)(data, random)[:MOST]
        if random.random() < 0.5:
            break
    return data


def smaller(data):
    """Candidates for a smaller file with the same defect: lines, then ever shorter pieces left out."""
    lines = data.splitlines(keepends=True)
    for count in (len(lines) // 2, len(lines) // 4, len(lines) // 8, 1):
        for start in range(0, len(lines), max(count, 1)) if count else ():
            yield b"".join(lines[:start] + lines[start + count :])
    length = len(data) // 2
    while length:
        for start in range(0, len(data), length):
            yield data[:start] + data[start + length :]
        length //= 2
