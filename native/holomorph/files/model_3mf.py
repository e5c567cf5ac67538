"""3MF as pieces: the triangles of all that is to be built, in millimetres."""

import io
import zipfile
from functools import cache
from urllib.parse import unquote
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from .._native import InvalidMesh
from ..core.value import quoted

UP = "Z"
NAME = "3MF"
RELATIONS = "_rels/.rels"
FIRST = "3D/3dmodel.model"  # where the relations of the package name no other
MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"  # the relation
MILLIMETRES = {"micron": 0.001, "millimeter": 1, "centimeter": 10, "inch": 25.4, "foot": 304.8, "meter": 1000}
UNREAD = {"beamlattice": "its beam lattices are not read", "slice": "its slices are not read"}
MOST_NESTED = 64  # components of components
MOST_BYTES, MOST_PACKED = 2**24, 200  # of a part, and beyond these for each byte in the archive


def placed(content, _path, notes):
    """Yields (points, triangles, matrix), and adds to the notes. @throws InvalidMesh, and what a damaged file leads
    to"""
    yield from _Package(zipfile.ZipFile(io.BytesIO(content)), notes).built()


class _Package:
    """Programs write the names of parts with either slash, in any case."""

    def __init__(self, archive, notes):
        self._archive, self._notes = archive, notes
        self._names = {_plain(name): name for name in archive.namelist()}
        self._model = cache(lambda path: _Model(self._read(path), notes))

    def built(self):
        first = self._first()
        model = self._model(first)
        if model.unit not in MILLIMETRES:
            raise InvalidMesh(f"its unit is {quoted(model.unit)}; one of {', '.join(MILLIMETRES)} is needed")
        scale = np.diag([MILLIMETRES[model.unit]] * 3 + [1.0])
        for item in model.items:
            yield from self._object(item, first, scale, 0)

    def _object(self, named, path, matrix, depth):
        """The pieces of the object that an item or a component names."""
        number, matrix = named.get("objectid"), _matrix(named) @ matrix
        path = next((value for key, value in named.items() if key.endswith(" path")), path)  # of any extension
        if depth > MOST_NESTED:
            raise InvalidMesh(f"object {number} is a part of itself")
        found = self._model(path).objects.get(number)
        if found is None:
            raise InvalidMesh(f"it has no object {number} in {path}")
        if "support" in found.kind:
            self._notes.append("its objects for support are not read")
            return
        if not found.triangles and not found.parts:
            self._notes.append(f"object {number} has no triangles")
        yield np.reshape(found.points, (-1, 3)), np.reshape(found.triangles, (-1, 3)).astype(np.int64), matrix
        for part in found.parts:
            yield from self._object(part, path, matrix, depth + 1)

    def _first(self):
        if RELATIONS in self._names:
            for relation in ElementTree.fromstring(self._read(RELATIONS)):
                if relation.get("Type") == MODEL:
                    return relation.get("Target")
        return FIRST

    def _read(self, path):
        name = self._names.get(_plain(path)) or self._names.get(_plain(unquote(path)))
        if name is None:
            raise InvalidMesh(f"it has no part {path}")
        about = self._archive.getinfo(name)
        if about.file_size > MOST_BYTES and about.file_size > MOST_PACKED * about.compress_size:
            raise InvalidMesh(f"{path} is packed {about.file_size // max(about.compress_size, 1)} times")
        return self._archive.read(about)


class _Object:
    def __init__(self, kind):
        self.kind, self.points, self.triangles, self.parts = kind, [], [], []


class _Model:
    """A part of the package. It is read as events: files for printers have millions of elements."""

    def __init__(self, content, notes):
        self.unit, self.objects, self.items, self._notes = "millimeter", {}, [], notes
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler = self._start
        parser.Parse(content, True)

    def _start(self, name, about):
        name = name.rpartition(" ")[2]
        if name == "vertex":
            self._last.points += _numbers(name, about, ("x", "y", "z"), float)
        elif name == "triangle":
            self._last.triangles += _numbers(name, about, ("v1", "v2", "v3"), int)
        elif name == "object":
            self._last = self.objects[about.get("id")] = _Object(about.get("type", "model"))
        elif name == "component":
            self._last.parts.append(about)
        elif name == "item":
            self.items.append(about)
        elif name == "model":
            self.unit = about.get("unit", self.unit)
        elif name in UNREAD:
            self._notes.append(UNREAD[name])


def _numbers(element, about, names, kind):
    for name in names:
        if name not in about:
            raise InvalidMesh(f"a {element} of it has no {name}")
    try:
        return [kind(about[name]) for name in names]
    except ValueError as error:
        told = ", ".join(f"{name}={quoted(about[name])}" for name in names)
        raise InvalidMesh(f"a {element} of it has {told}: numbers with decimal points are needed") from error


def _plain(name):
    return name.replace("\\", "/").lstrip("/").lower()


def _matrix(element):
    """(4, 4), which multiplies rows from the right."""
    numbers = element.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()
    return np.column_stack([np.array(numbers, float).reshape(4, 3), [0, 0, 0, 1]])
