"""From sources to tasks: what there is to do in an output folder, and where the results of each asset are there."""

import hashlib
import json

from .. import __version__
from ..files.names import marked, part, told_apart
from . import blend, sources
from .journal import RECORD, noted
from .task import Task

LONGEST = 1000  # of the whole path below the output folder; systems take 4096
ASSETS, SCENES = "assets", ".blend"  # folders of the results: of assets, and of what Blender read of scenes


def of_folder(name):
    """A folder of assets as one part of a path. Where it has a suffix of a source, an asset may have its name, too:
    its dot is told apart."""
    plain = part(name)
    stem, dot, suffix = plain.rpartition(".")
    return f"{stem}%2E{suffix}" if dot and f".{suffix.lower()}" in sources.WANTED else plain


def of_source(name):
    """The path of a source, whose parts between slashes are folders."""
    *folders, last = name.split("/")
    path = "/".join([*(of_folder(folder) for folder in folders), part(last)])
    return path if len(path) <= LONGEST else marked(part(last), name)


class Plan:
    """The tasks of a batch. `openings` come first: they read scenes, whose objects are then assets, too.

    found : all sources, which tell each other's folders apart; share : those of this run
    """

    def __init__(self, found, journal, recipe, limits, blender, share=slice(None)):
        self._journal, self._recipe, self._more = journal, recipe, {"blender": blender, "limits": limits}
        self._places = told_apart([source.name for source in found], of_source)
        tasks = [self._of_source(source) for source in found[share]]
        self.openings = [task for task in tasks if task.recipe is None]
        self._meshes = [task for task in tasks if task.recipe]

    def tasks(self):
        """The tasks of the mesh files, and of the objects of the scenes that were read."""
        opened = [opening for opening in self.openings if _is_read(opening)]
        return self._meshes + [task for opening in opened for task in self._objects(opening)]

    def unopened(self):
        """The scenes that were not read: each is an asset in itself, which is not done."""
        return [opening for opening in self.openings if not _is_read(opening)]

    def _of_source(self, source):
        problem, digest = _examined(source)
        is_scene = sources.is_scene(source.path)
        folder, recipe = (SCENES, None) if is_scene else (ASSETS, self._recipe)
        place = f"{folder}/{self._places[source.name]}"
        return self._task(source.name, digest, source.path, source.size, place, recipe, problem=problem)

    def _objects(self, opening):
        found = blend.objects(opening.folder)
        folders = told_apart([name for name, *_ in found], part)
        for name, path, corners in found:
            shown = name.replace("%", "%25").replace("/", "%2F")
            place = f"{ASSETS}/{self._places[opening.name]}/{folders[name]}"
            scene = str(opening.path), name
            yield self._task(f"{opening.name}/{shown}", opening.key, path, corners, place, self._recipe, scene=scene)

    def _task(self, name, digest, path, size, place, recipe, **more):
        """digest : a hash of the bytes of the source"""
        parts = digest, name, recipe and recipe.canonical, __version__
        key = hashlib.sha256(json.dumps(parts).encode()).hexdigest()
        folders = self._journal.folder / place, self._journal.work
        return Task(name, key, path.absolute(), size, *folders, recipe, **self._more, **more)


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
