"""From sources to tasks: what there is to do in an output folder, and where the results of each asset are there: its
name as a path that every file system takes, for it alone.

Most names are their own paths. In others, bytes that some file system does not take are %XX; what is too long is cut
and, like names that differ in case alone, told apart by a hash after a ^, which stands in no other path.
"""

import hashlib
import os
import re
from urllib.parse import quote

from . import blend, sources
from .journal import RECORD, noted
from .task import Task, key

PLAIN = " !#$&'()+,;=@[]{}~"  # besides letters, digits and _.-
LONGEST_PART = 200  # bytes; file systems take 255, some of those that encrypt 143 to 200
LONGEST = 1000  # of the whole path below the output folder; systems take 4096
HASH = 32  # hexadecimal digits: 128 bits
SUFFIX = re.compile(r"\.[0-9A-Za-z]{1,8}$")
ASSETS, SCENES = "assets", ".blend"  # folders of the results: of assets, and of what Blender read of scenes
KINDS = (*sources.MESHES, *sources.SCENES)


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


def of_folder(name):
    """A folder of assets as one part of a path. Where it has a suffix of `KINDS`, an asset may have its name, too:
    its dot is told apart."""
    plain = part(name)
    stem, dot, suffix = plain.rpartition(".")
    return f"{stem}%2E{suffix}" if dot and f".{suffix.lower()}" in KINDS else plain


def of_source(name):
    """The path of a source, whose parts between slashes are folders."""
    *folders, last = name.split("/")
    path = "/".join([*(of_folder(folder) for folder in folders), part(last)])
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


class Plan:
    """The tasks of a batch. `openings` come first: they read scenes, whose objects are then assets, too.

    found : all sources, which tell each other's folders apart; share : those of this run
    """

    def __init__(self, found, journal, recipe, threads, blender, share=slice(None)):
        self._journal, self._recipe, self._threads, self._blender = journal, recipe, threads, blender
        self._places = told_apart([source.name for source in found], of_source)
        self.openings = [self._opening(source) for source in found[share] if sources.is_scene(source.path)]
        self._meshes = [self._mesh(source) for source in found[share] if not sources.is_scene(source.path)]

    def tasks(self):
        """The tasks of the mesh files, and of the objects of the scenes that were read."""
        opened = [opening for opening in self.openings if _is_read(opening)]
        return self._meshes + [task for opening in opened for task in self._objects(opening)]

    def unopened(self):
        """The scenes that were not read: each is an asset in itself, which is not done."""
        return [opening for opening in self.openings if not _is_read(opening)]

    def _opening(self, source):
        problem, digest = _examined(source)
        return blend.Opening(
            source.name,
            digest,
            source.path.absolute(),
            source.size,
            self._journal.folder / SCENES / self._places[source.name],
            self._journal.work,
            self._blender,
            problem,
        )

    def _mesh(self, source):
        problem, digest = _examined(source)
        place = self._places[source.name]
        return self._task(source.name, place, source.path, source.size, digest, problem=problem)

    def _objects(self, opening):
        found = list(opening.objects())
        folders = told_apart([name for name, *_ in found], part)
        for name, path, corners in found:
            shown = name.replace("%", "%25").replace("/", "%2F")
            place = f"{self._places[opening.name]}/{folders[name]}"
            scene = str(opening.path), name
            yield self._task(f"{opening.name}/{shown}", place, path, corners, opening.key, scene=scene)

    def _task(self, name, place, path, size, digest, **more):
        return Task(
            name=name,
            key=key(digest, name, self._recipe),
            path=path.absolute(),
            size=size,
            folder=self._journal.folder / ASSETS / place,
            work=self._journal.work,
            recipe=self._recipe,
            blender=self._blender,
            threads=self._threads,
            **more,
        )


def _is_read(opening):
    """Whether its objects are there, as they were listed: a record of another shape is that of another program."""
    is_own = noted(opening) is not None or not (opening.folder / RECORD).exists()
    return is_own and (opening.folder / blend.OBJECTS).exists()


def _examined(source):
    """(why it cannot be read, or empty; a hash of its bytes, or of that)."""
    problem = source.problem
    if not problem:
        try:
            with open(source.path, "rb") as file:
                return "", hashlib.file_digest(file, "sha256").hexdigest()
        except OSError as error:
            problem = sources.cannot_be_read("file", error)
    return problem, hashlib.sha256(problem.encode()).hexdigest()
