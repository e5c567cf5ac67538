"""The files that a batch maps, and their names in its results."""

import codecs
import errno
import fnmatch
import glob
import os
import stat
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

from ..files import formats
from . import UsageError

MESHES = (*formats.POLYGONAL, ".3mf")
SCENES = tuple(formats.IMPORTERS)
WANTED = (*MESHES, *SCENES)
LIST = ".txt"  # one path or pattern per line, from the list's own folder on; lines with # are comments
KINDS = f"a folder, a pattern, a list ({LIST}), a scene ({', '.join(SCENES)}) or a mesh file ({', '.join(MESHES)})"


@dataclass(frozen=True)
class Source:
    """A file, of the kind that its name says, a link's own name where it is one.

    name : its path below the folder that was given, or below the pattern's; unique in a batch
    size : in bytes; problem : why it cannot be read, or empty
    """

    name: str
    path: Path
    size: int = 0
    problem: str = ""


def find(given, out):
    """The sources of the paths, patterns and lists, ordered by name. `out`: where results will be.

    What is found in a folder or by a pattern and cannot be read is a source with a problem.

    Raises UsageError for what is none, or is named and cannot be read, where two have one name, or `out` lies in a
    given folder.
    """
    found = {}
    for entry in given:
        for source in _expanded(str(entry), Path(), out):
            other = found.setdefault(source.name, source)
            if os.path.realpath(other.path) != os.path.realpath(source.path):
                raise UsageError(
                    f"two sources have the name {source.name}: {other.path} and {source.path}; rename one, or give a "
                    "folder that holds both"
                )
    return [found[name] for name in sorted(found)]


def _expanded(entry, base, out):
    path = base / entry
    if os.path.isdir(path):
        return _in_folder(path, out)
    if path.suffix.lower() == LIST and os.path.isfile(path):
        return _in_list(path, out)
    if os.path.lexists(path):
        return [_named(path)]
    before = takewhile(lambda part: not glob.has_magic(part), path.relative_to(path.anchor).parts)
    fixed = Path(path.anchor, *before)  # the parts of a pattern before the first wildcard
    matches = sorted(_matches(fixed, path.relative_to(fixed).parts))
    if not matches:
        raise UsageError(f"{path}: there is no such file, folder or pattern")
    files = [file for file in matches if _is_wanted(file)]
    if not files:
        raise UsageError(f"{path}: nothing that matches is {KINDS}")
    return [_file(file, file.relative_to(fixed).as_posix()) for file in files]


def _matches(fixed, parts):
    """The paths below a folder that match a pattern's parts; ** follows no links to folders: some are circular."""
    if "**" not in parts:
        return [fixed / found for found in glob.glob("/".join(parts), root_dir=fixed)]
    below, _ = _walked(fixed)
    return [path for path in below if _fits(path.relative_to(fixed).parts, parts)]


def _fits(names, parts):
    """Whether parts of a pattern match names; those that begin with a dot are named so."""
    if not parts:
        return not names
    if parts[0] == "**" and _fits(names, parts[1:]):
        return True
    if not names or (names[0].startswith(".") and not parts[0].startswith(".")):
        return False
    if parts[0] == "**":
        return _fits(names[1:], parts)
    return fnmatch.fnmatchcase(names[0], parts[0]) and _fits(names[1:], parts[1:])


def _in_folder(folder, out):
    """Links to folders are not followed."""
    if Path(os.path.realpath(out)).is_relative_to(os.path.realpath(folder)):
        raise UsageError(f"{out}: the output folder lies in the source {folder}; choose another place")
    below, unread = _walked(folder)
    found = [_file(path, path.relative_to(folder).as_posix()) for path in below if _is_wanted(path)]
    found += [Source(path.relative_to(folder).as_posix() + "/", path, problem=problem) for path, problem in unread]
    if not found:
        raise UsageError(f"{folder}: there is no mesh file and no scene ({', '.join(SCENES)}) in this folder")
    return found


def _walked(folder):
    """The paths of all files below a folder, and (path, problem) of the folders that cannot be read."""
    files, unread, folders = [], [], [folder]
    while folders:
        place = folders.pop()
        try:
            with os.scandir(place) as entries:
                for entry in entries:
                    (folders if entry.is_dir(follow_symlinks=False) else files).append(place / entry.name)
        except OSError as error:
            unread.append((place, cannot_be_read("folder", error)))
    return files, unread


def _in_list(path, out):
    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: the list cannot be read: {error.strerror}") from error
    is_utf_16 = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))  # as Windows' shell writes
    text = content.decode("utf-16" if is_utf_16 else "utf-8-sig", errors="surrogateescape")  # names are bytes
    lines = [line.strip(" \t\r") for line in text.split("\n")]  # names may have what other line ends are made of
    entries = [line for line in lines if line and not line.startswith("#")]
    if not entries:
        raise UsageError(f"{path}: the list is empty")
    return [source for entry in entries for source in _expanded(entry, path.parent, out)]


def _is_wanted(path):
    return path.suffix.lower() in WANTED and not os.path.isdir(path)


def is_scene(path):
    return path.suffix.lower() in SCENES


def _named(path):
    """@throws UsageError for what is not a mesh by its name, not a file, or not readable"""
    source = _file(path, path.name)
    if not _is_wanted(path):
        raise UsageError(f"{path}: {KINDS} is needed")
    if source.problem:
        raise UsageError(f"{path}: {source.problem}")
    return source


def _file(path, name):
    try:
        found = path.stat()  # opening a pipe would wait for its other end
        if not stat.S_ISREG(found.st_mode):
            return Source(name, path, problem="this is not a regular file")
        with open(path, "rb") as file:
            file.read(1)
    except OSError as error:
        return Source(name, path, problem=cannot_be_read("file", error))
    return Source(name, path, found.st_size)


def cannot_be_read(noun, error):
    """The sentence. @throws OSError where that is for want of file numbers, which is no fault of the file"""
    if error.errno in (errno.EMFILE, errno.ENFILE):
        raise error
    return f"the {noun} cannot be read: {error.strerror}"
