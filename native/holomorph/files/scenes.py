"""Files that put several meshes at their places, as one mesh of triangles: glTF and 3MF."""

import os
import struct
import zipfile
import zlib
from pathlib import Path
from xml.parsers.expat import ExpatError

import numpy as np

from .._native import Error, InvalidMesh
from . import gltf, model_3mf, whole_file

KINDS = {".glb": gltf, ".gltf": gltf, ".3mf": model_3mf}
MOST_PIECES, MOST_TRIANGLES = 100_000, 50_000_000  # files may repeat a mesh: a small one never needs much memory
MALFORMED = (ValueError, TypeError, KeyError, IndexError, AttributeError, OverflowError, RecursionError, RuntimeError)
MALFORMED += (EOFError, struct.error, zipfile.BadZipFile, zlib.error, ExpatError, SyntaxError)  # of ElementTree
POINTER = b"version https://git-lfs"  # begins what stands for a large file in a checkout without it


def kind(path):
    """The module that reads the file, by its name, or None."""
    return KINDS.get(Path(os.fsdecode(path)).suffix.lower())


def read(path, weld):
    """((vertices, corner_vertices, face_offsets), sentences about what is not read). weld : join equal vertices, and
    leave out what that makes of triangles with fewer corners. @throws InvalidMesh"""
    notes, reader = [], kind(path)
    try:
        content = whole_file.read(path)
        if content.startswith(POINTER):
            raise InvalidMesh("this is a pointer of Git LFS, not the model: fetch that with 'git lfs pull'")
        points, triangles = joined(reader.placed(content, path, notes))
    except Error as error:
        raise type(error)(f"{os.fsdecode(path)}: {error}") from error
    except OSError as error:
        problem = "there is no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise InvalidMesh(f"{os.fsdecode(error.filename or path)}: {problem}") from error
    except MALFORMED as error:
        told = f"it has no {error}" if isinstance(error, KeyError) else f"it cannot be read as {reader.NAME}"
        raise InvalidMesh(f"{os.fsdecode(path)}: the file is damaged: {told}") from error
    if weld:
        points, places = np.unique(points + 0.0, axis=0, return_inverse=True)  # -0.0 is 0.0
        triangles = with_three_corners(places.ravel()[triangles])
    return (points, triangles.ravel(), np.arange(len(triangles) + 1) * 3), tuple(dict.fromkeys(notes))


def fault(path):
    """What is wrong with a file that another program could not read, None where that is not known here."""
    try:
        return kind(path) and read(path, False) and None
    except InvalidMesh as error:
        return str(error)


def joined(pieces):
    """(points, triangles) of all pieces: (points, triangles, (4, 4) matrix that multiplies rows from the right)."""
    points, triangles, count, total = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0, 0
    for given, corners, matrix in pieces:
        total += len(corners)
        if len(points) > MOST_PIECES or total > MOST_TRIANGLES:
            raise InvalidMesh(
                f"it repeats its meshes; at most {MOST_TRIANGLES:,} triangles of {MOST_PIECES:,} are read"
            )
        used, places = np.unique(corners, return_inverse=True)
        if len(used) and not 0 <= used[0] <= used[-1] < len(given):
            raise InvalidMesh(f"a triangle has vertex {used[0] if used[0] < 0 else used[-1]} of {len(given)}")
        with np.errstate(invalid="ignore"):  # faces at what is infinite are refused later
            points.append(given[used] @ matrix[:3, :3] + matrix[3, :3])
        mirrors = np.linalg.det(matrix[:3, :3]) < 0
        triangles.append((places.reshape(-1, 3) + count)[:, :: -1 if mirrors else 1])
        count += len(used)
    return np.concatenate(points), np.concatenate(triangles)


def with_three_corners(triangles):
    """Those whose corners are three vertices."""
    return triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
