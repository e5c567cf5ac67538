"""Names as paths of files that no other one has, on every file system.

Most names are their own paths. In others, bytes that some file system does not take are %XX; what is too long is cut
and, like names that differ in case alone, told apart by a hash after a ^, which stands in no other path.
"""

import hashlib
import os
import re
import unicodedata
from collections import Counter
from urllib.parse import quote

PLAIN = " !#$&'()+,;=@[]{}~"  # besides letters, digits and _.-
LONGEST_PART = 200  # bytes; file systems take 255, some of those that encrypt 143 to 200
HASH = 32  # hexadecimal digits: 128 bits
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\.|$)", re.IGNORECASE)  # in Windows, with any suffix
SUFFIX = re.compile(r"\.[0-9A-Za-z]{1,8}$")


def part(name):
    """A name as one part of a path; none is a folder's own, whose name ends in a slash. A dot or a space at its end
    would be lost on some file systems."""
    if not name:
        return "^"
    plain = quote(os.fsencode(name), safe=PLAIN)
    if plain.strip(".") == "":
        plain = plain.replace(".", "%2E")
    elif plain[-1] in ". ":
        plain = plain[:-1] + quote(plain[-1], safe="").replace(".", "%2E")
    if RESERVED.match(plain):
        plain = f"%{ord(plain[0]):02X}{plain[1:]}"
    return plain if len(plain) <= LONGEST_PART else marked(plain, name)


def marked(plain, name):
    """The path of a name, cut and with the hash of the name, before its suffix."""
    found = SUFFIX.search(plain)
    suffix = found[0] if found else ""
    start = plain[: len(plain) - len(suffix)][: LONGEST_PART - len(suffix) - HASH - 1]
    return re.sub("%.?$", "", start) + "^" + hashlib.sha256(os.fsencode(name)).hexdigest()[:HASH] + suffix


def told_apart(names, path):
    """{name: path(name)}, with its hash where another one's path differs in case alone, or not at all."""
    paths = {name: path(name) for name in names}
    count = Counter(map(_regardless_of_case, paths.values()))
    return {
        name: _marked_last(plain, name) if count[_regardless_of_case(plain)] > 1 else plain
        for name, plain in paths.items()
    }


def _regardless_of_case(plain):
    """Equal where a file system may take two paths for one: some also compose letters and accents."""
    return unicodedata.normalize("NFC", plain).casefold()


def _marked_last(plain, name):
    folder, slash, last = plain.rpartition("/")
    return folder + slash + marked(last, name)
