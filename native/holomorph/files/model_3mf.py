"""3MF as pieces: the triangles of all that is to be built, in millimetres.

Numbers are found in the text of whole lists, since files for printers have millions; the rest is read as XML.
"""

import io
import re
import zipfile
from xml.etree import ElementTree

import numpy as np

from .._native import InvalidMesh
from . import whole_file

UP = "Z"
FIRST = "3D/3dmodel.model"  # where the relations of the package name no other
MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"  # the relation
MILLIMETRES = {"micron": 0.001, "millimeter": 1, "centimeter": 10, "inch": 25.4, "foot": 304.8, "meter": 1000}
LIST = re.compile(rb"<((?:\w+:)?)(vertices|triangles)>(.*?)</\1\2>", re.DOTALL)
NAMES = {b"vertices": ("x", "y", "z"), b"triangles": ("v1", "v2", "v3")}
MOST_NESTED = 64  # components of components
MOST_BYTES, MOST_PACKED = 2**24, 200  # of a part, and beyond these for each byte in the archive


def placed(path):
    """Yields (points, triangles, matrix). @throws InvalidMesh, OSError, and what a damaged file leads to"""
    yield from _Package(zipfile.ZipFile(io.BytesIO(whole_file.read(path)))).built()


class _Package:
    def __init__(self, archive):
        self._archive, self._models = archive, {}

    def built(self):
        first = self._first()
        root, _ = self._model(first)
        scale = np.diag([MILLIMETRES[root.get("unit", "millimeter")]] * 3 + [1.0])
        for item in _named(root, "item"):
            yield from self._object(_path(item, first), item.get("objectid"), _matrix(item) @ scale, 0)

    def _object(self, path, number, matrix, depth):
        if depth > MOST_NESTED:
            raise InvalidMesh(f"object {number} is a part of itself")
        root, lists = self._model(path)
        found = {each.get("id"): each for each in _named(root, "object")}[number]
        for mesh in _named(found, "mesh"):
            points, triangles = (
                lists[int(mesh.find(f"{{*}}{name}").get("list"))] for name in ("vertices", "triangles")
            )
            yield points, triangles.astype(np.int64), matrix
        for part in _named(found, "component"):
            yield from self._object(_path(part, path), part.get("objectid"), _matrix(part) @ matrix, depth + 1)

    def _first(self):
        if "_rels/.rels" in self._archive.namelist():
            for relation in ElementTree.fromstring(self._read("_rels/.rels")):
                if relation.get("Type") == MODEL:
                    return relation.get("Target").lstrip("/")
        return FIRST

    def _model(self, path):
        """(root, lists of numbers) of a part of the package."""
        if path not in self._models:
            lists = []

            def taken(match):
                lists.append(_columns(match[3], NAMES[match[2]]))
                return b'<%s%s list="%d"/>' % (match[1], match[2], len(lists) - 1)

            root = ElementTree.fromstring(LIST.sub(taken, self._read(path)))
            self._models[path] = root, lists
        return self._models[path]

    def _read(self, path):
        about = self._archive.getinfo(path)
        if about.file_size > MOST_BYTES and about.file_size > MOST_PACKED * about.compress_size:
            raise InvalidMesh(f"{path} is packed {about.file_size // max(about.compress_size, 1)} times")
        return self._archive.read(about)


def _columns(text, names):
    """(n, 3) values of three attributes of each element."""
    columns = [re.findall(rb"\s%s\s*=\s*[\"']\s*([^\"'\s]+)" % name.encode(), text) for name in names]
    count = text.count(b"<") - text.count(b"</") - text.count(b"<!")
    if {len(column) for column in columns} != {count} and count:
        raise InvalidMesh(f"not every one of {count} elements has {', '.join(names)}")
    return np.array(columns, "S").astype(float).reshape(3, -1).T


def _named(element, name):
    return element.iterfind(f".//{{*}}{name}")


def _path(element, default):
    """The part of the package that an element names, of whichever extension the attribute is."""
    found = [value for key, value in element.items() if key.endswith("}path")]
    return found[0].lstrip("/") if found else default


def _matrix(element):
    """(4, 4), which multiplies rows from the right."""
    numbers = element.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()
    return np.column_stack([np.array(numbers, float).reshape(4, 3), [0, 0, 0, 1]])
