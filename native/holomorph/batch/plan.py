"""From sources to tasks: what there is to do in an output folder."""

import hashlib

from . import blend, sources
from .journal import safe
from .task import Task, key


class Plan:
    """The tasks of a batch. `openings` come first: they read scenes, whose objects are then assets, too."""

    def __init__(self, found, journal, recipe, threads, blender):
        self._journal, self._recipe, self._threads, self._blender = journal, recipe, threads, blender
        digests = {source: _digest(source.path) for source in found}
        scenes = [source for source in found if sources.is_scene(source.path)]
        meshes = [source for source in found if source not in scenes]
        self.openings = [self._opening(source, digests[source]) for source in scenes]
        self._meshes = [self._task(source.name, source.path, source.size, digests[source]) for source in meshes]

    def tasks(self):
        """Those of the mesh files, and of the objects of the scenes that were read."""
        opened = [opening for opening in self.openings if (opening.folder / blend.OBJECTS).exists()]
        return self._meshes + [task for opening in opened for task in self._objects(opening)]

    def unopened(self):
        """The scenes that were not read: each is an asset in itself, which is not done."""
        return [opening for opening in self.openings if not (opening.folder / blend.OBJECTS).exists()]

    def _opening(self, source, digest):
        folder, work = self._journal.folder / ".blend" / safe(source.name), self._journal.work
        return blend.Opening(source.name, digest, source.path.resolve(), source.size, folder, work, self._blender)

    def _objects(self, opening):
        return [
            self._task(
                f"{opening.name}/{name.replace('/', '%2F')}", path, corners, opening.key, (str(opening.path), name)
            )
            for name, path, corners in opening.objects()
        ]

    def _task(self, name, path, size, digest, scene=None):
        return Task(
            name=name,
            key=key(digest, name, self._recipe),
            path=path.resolve(),
            size=size,
            folder=self._journal.asset_folder(name),
            work=self._journal.work,
            recipe=self._recipe,
            scene=scene,
            blender=self._blender,
            threads=self._threads,
        )


def _digest(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
