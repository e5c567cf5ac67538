"""The files that a batch maps, and their names in its results."""

import glob
from dataclasses import dataclass
from pathlib import Path

from .errors import UsageError

MESHES = (".obj", ".off", ".ply", ".stl")
SCENES = (".blend", ".glb", ".gltf", ".fbx", ".usd", ".usda", ".usdc", ".usdz")  # which Blender reads
LIST = ".txt"  # one path or pattern per line, from the list's own folder on; lines with # are comments
KINDS = f"a folder, a pattern, a list ({LIST}), a scene ({', '.join(SCENES)}) or a mesh file ({', '.join(MESHES)})"


@dataclass(frozen=True)
class Source:
    """A file. `name` is its path below the folder that was given, or below the pattern's; unique in a batch."""

    name: str
    path: Path

    @property
    def size(self):
        """Bytes."""
        return self.path.stat().st_size


def find(given, out):
    """The sources of the paths, patterns and lists, ordered by name. `out`: where results will be.

    Raises UsageError for what is none, or cannot be read, where two have one name, or `out` lies in a given folder.
    """
    found = {}
    for entry in given:
        for source in _expanded(str(entry), Path(), out):
            other = found.setdefault(source.name, source)
            if other.path.resolve() != source.path.resolve():
                raise UsageError(
                    f"two sources have the name {source.name}: {other.path} and {source.path}; rename one, or give a "
                    "folder that holds both"
                )
    return [found[name] for name in sorted(found)]


def _expanded(entry, base, out):
    path = base / entry
    if path.is_dir():
        return _in_folder(path, out)
    if path.exists():
        return _in_list(path, out) if path.suffix.lower() == LIST else [_file(path, path.name)]
    matches = sorted(glob.glob(str(path), recursive=True))
    if not matches:
        raise UsageError(f"{path}: there is no such file, folder or pattern")
    fixed = Path(path.anchor, *_fixed_parts(path))
    files = [Path(match) for match in matches if _is_wanted(Path(match))]
    if not files:
        raise UsageError(f"{path}: nothing that matches is {KINDS}")
    return [_file(file, file.relative_to(fixed).as_posix()) for file in files]


def _fixed_parts(path):
    """The parts of a pattern before the first wildcard."""
    for part in path.relative_to(path.anchor).parts:
        if glob.has_magic(part):
            return
        yield part


def _in_folder(folder, out):
    if out.resolve().is_relative_to(folder.resolve()):
        raise UsageError(f"{out}: the output folder lies in the source {folder}; choose another place")
    files = [file for file in folder.rglob("*") if _is_wanted(file)]
    if not files:
        raise UsageError(f"{folder}: there is no mesh file and no scene ({', '.join(SCENES)}) in this folder")
    return [_file(file, file.relative_to(folder).as_posix()) for file in files]


def _in_list(path, out):
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: the list cannot be read: {error}") from error
    entries = [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not entries:
        raise UsageError(f"{path}: the list is empty")
    return [source for entry in entries for source in _expanded(entry, path.parent, out)]


def _is_wanted(path):
    return path.suffix.lower() in (*MESHES, *SCENES) and not path.is_dir()


def is_scene(path):
    return path.suffix.lower() in SCENES


def _file(path, name):
    """@throws UsageError what is no mesh by its name, no file, or not readable"""
    if not _is_wanted(path):
        raise UsageError(f"{path}: {KINDS} is needed")
    try:
        if not path.is_file():
            raise UsageError(f"{path}: this is not a regular file")
        with open(path, "rb") as file:
            file.read(1)
    except OSError as error:
        raise UsageError(f"{path}: the file cannot be read: {error.strerror}") from error
    return Source(name, path)
