"""Where the results of each asset are: its name as a path that every file system takes, for it alone.

Most names are their own paths. In others, bytes that some file system does not take are %XX; what is too long is cut
and, like names that differ in case alone, told apart by a hash after a ^, which stands in no other path.
"""

import hashlib
import os
import re
from urllib.parse import quote

PLAIN = " !#$&'()+,;=@[]{}~"  # besides letters, digits and _.-
LONGEST_PART = 200  # bytes; file systems take 255, some of those that encrypt 143 to 200
LONGEST = 1000  # of the whole path below the output folder; systems take 4096
HASH = 32  # hexadecimal digits: 128 bits
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
    return plain if len(plain) <= LONGEST_PART else marked(plain, name)


def marked(plain, name):
    """The path of a name, cut and with the hash of the name, before its suffix."""
    found = SUFFIX.search(plain)
    suffix = found[0] if found else ""
    start = plain[: len(plain) - len(suffix)][: LONGEST_PART - len(suffix) - HASH - 1]
    return re.sub("%.?$", "", start) + "^" + hashlib.sha256(os.fsencode(name)).hexdigest()[:HASH] + suffix


def of_folder(name, kinds):
    """A folder of assets as one part of a path. Where it has a suffix of these kinds, an asset may have its name, too:
    its dot is told apart."""
    plain = part(name)
    stem, dot, suffix = plain.rpartition(".")
    return f"{stem}%2E{suffix}" if dot and f".{suffix.lower()}" in kinds else plain


def of_source(name, kinds):
    """The path of a source, whose parts between slashes are folders."""
    *folders, last = name.split("/")
    path = "/".join([*(of_folder(folder, kinds) for folder in folders), part(last)])
    return path if len(path) <= LONGEST else marked(part(last), name)


def told_apart(names, path):
    """{name: path(name)}, with its hash where another one's path differs in case alone, or not at all."""
    paths = {name: path(name) for name in names}
    count = {}
    for plain in paths.values():
        count[plain.lower()] = count.get(plain.lower(), 0) + 1
    return {name: _marked_last(plain, name) if count[plain.lower()] > 1 else plain for name, plain in paths.items()}


def _marked_last(plain, name):
    folder, slash, last = plain.rpartition("/")
    return folder + slash + marked(last, name)
