"""The arrays that a progressive mesh is made of, as one .npz file, which NumPy reads anywhere."""

import io
import zlib
from zipfile import BadZipFile, ZipFile

import numpy as np

from .. import _native
from .._native import InvalidMesh
from ..files import whole_file

ROWS = {
    "base_triangles": (np.int32, (3,)),
    "split_vertices": (np.int32, (3,)),
    "split_slots": (np.uint8, (2,)),
    "positions": (np.float64, (3,)),
    "vertex_index": (np.int32, ()),
    "triangle_index": (np.int32, ()),
    "triangle_corners": (np.int32, (3,)),
    "face_offsets": (np.int32, ()),
}
"""The type and shape of one row of each."""

# What NumPy and zipfile raise for bytes that are no file of arrays: RuntimeError also for ways of compression that they
# do not know, MemoryError for what the first bytes of an array ask for.
DAMAGED = ValueError, KeyError, EOFError, OSError, RuntimeError, MemoryError, BadZipFile, zlib.error


def arrays_of(native):
    """{name: array} of a native progressive mesh: `ROWS`."""
    return {name: getattr(native, name) for name in ROWS}


def native_of(given):
    """The native progressive mesh of its arrays; every count, index and split is checked. Raises InvalidMesh"""
    for name, (kind, shape) in ROWS.items():
        if name not in given:
            raise InvalidMesh(f"the progressive mesh has no array {name}")
        array = given[name]
        if array.dtype.newbyteorder("=") != kind or array.ndim == 0 or array.shape[1:] != shape:
            raise InvalidMesh(f"the progressive mesh is damaged: {name} has the wrong type or shape")
    if len(given["split_vertices"]) != len(given["split_slots"]):
        raise InvalidMesh("the progressive mesh is damaged: there are not as many slots as splits")
    return _native.ProgressiveMesh.of_arrays(**{name: given[name] for name in ROWS})


def write(path, arrays):
    content = io.BytesIO()
    np.savez(content, **arrays)
    whole_file.write(path, content.getbuffer())


def read(path):
    """{name: array}. Raises InvalidMesh for what is no such file; OSError"""
    content = whole_file.read(path)
    try:
        with ZipFile(io.BytesIO(content)) as file:
            # Nothing is compressed: a small file does not take much memory.
            if sum(member.file_size for member in file.infolist()) > len(content):
                raise BadZipFile("it is compressed")
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return dict(file)
    except DAMAGED as error:
        raise InvalidMesh(f"it is no undamaged .npz file of a progressive mesh ({error})") from error
