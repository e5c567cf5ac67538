"""Arrays from the caller, checked before they reach the native core."""

from itertools import chain

import numpy as np

from .._native import InvalidMesh
from .value import quoted


def real(array, columns, name):
    """`array` as C-contiguous float64 with `columns` columns."""
    try:
        result = numbers(array, name)
    except ValueError as error:
        raise InvalidMesh(str(error)) from error
    if result.ndim != 2 or result.shape[1] != columns:
        raise InvalidMesh(f"{name} has the shape {result.shape}; (rows, {columns}) is needed")
    return result


def numbers(array, name):
    """`array` as C-contiguous float64. @throws ValueError if it is not an array of real numbers, or has masked ones"""
    if np.ma.is_masked(array):
        raise ValueError(f"{name} has masked entries")
    if np.iscomplexobj(array):
        raise ValueError(f"{name} has complex entries; real numbers are needed")
    try:
        return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:  # the last for integers beyond all floats
        raise ValueError(f"{name} is not an array of numbers: {quoted(array)}") from error


def complex_numbers(array, name):
    """A new array of complex numbers. @throws ValueError if it is none of numbers"""
    try:
        return np.array(array, dtype=np.complex128)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name} must be an array of numbers, not {quoted(array)}") from error


def integer(array, name, dimensions=1, columns=None):
    """`array` as C-contiguous int32 where it is that, else int64; anything but integers is refused, never rounded."""
    try:
        result = np.asarray(array)
    except ValueError as error:
        raise InvalidMesh(f"{name} is not an array of integers: {quoted(array)}") from error
    if np.ma.is_masked(array):
        raise InvalidMesh(f"{name} has masked entries")
    _check_integers(result, name)
    if result.ndim != dimensions or (columns is not None and result.shape[1] not in columns):
        shape = " or ".join(f"(rows, {c})" for c in columns) if columns else f"of {dimensions} dimension(s)"
        raise InvalidMesh(f"{name} has the shape {result.shape}; {shape} is needed")
    return np.ascontiguousarray(result, dtype=np.int32 if result.dtype == np.int32 else np.int64)


def _check_integers(array, name):
    if array.dtype == np.uint64 and array.size and array.max() > np.iinfo(np.int64).max:
        raise InvalidMesh(f"{name} has an entry beyond 64-bit integers")
    if not (np.issubdtype(array.dtype, np.integer) or array.size == 0):
        raise InvalidMesh(f"{name} has the type {array.dtype}; integers are needed")


def polygons(faces):
    """Corner vertices and face offsets of (#F, n) integers, or of a list of lists of any sizes."""
    faces = np.asarray(faces) if isinstance(faces, memoryview) else faces
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        array = integer(faces, "faces", dimensions=2)
        if array.shape[1] < 3:
            raise InvalidMesh(
                f"faces has the shape {array.shape}; a column for each of three corners or more is needed"
            )
        kind = array.dtype if array.size <= np.iinfo(np.int32).max else np.int64  # too many are refused natively
        return array.ravel(), np.arange(0, array.size + 1, array.shape[1], dtype=kind)
    try:
        faces = list(faces)
        sizes = np.fromiter(map(len, faces), dtype=np.int64, count=len(faces))
    except TypeError as error:
        raise InvalidMesh(
            "faces must be an integer array with a row for each face, or a list of lists of vertices"
        ) from error
    corners = integer(list(chain.from_iterable(faces)), "faces")
    return corners, np.concatenate([[0], np.cumsum(sizes)])


def strip_triangles(corners, offsets):
    """(#T, 3) of bands of triangles, of which each begins at an offset. Every other triangle runs the other way; those
    with a vertex twice only lead to the next band, and are left out."""
    band = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    first = np.flatnonzero(np.arange(len(corners)) + 2 < offsets[1:][band])
    rows = corners[first[:, None] + [0, 1, 2]]
    is_turned = (first - offsets[band[first]]) % 2 == 1
    rows[is_turned] = rows[is_turned][:, [1, 0, 2]]
    return rows[(rows != np.roll(rows, 1, axis=1)).all(axis=1)]


def near_origin(points):
    """((#P, 3) points less a place, the place), so that single precision keeps their shape. Places are multiples of a
    power of two above four times the size: 0 for points near the origin, and exact in single precision."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / 2
    unit = max(4 * (high - low).max(), 2.0**-23 * np.abs(middle).max(), np.finfo(float).tiny)
    unit = 2.0 ** np.ceil(np.log2(unit))
    place = np.round(middle / unit) * unit + 0.0  # -0 becomes 0
    return points - place, place


def frozen(array):
    """The same array, read-only."""
    array.setflags(write=False)
    return array
