"""A mesh file for an application that holds meshes of its own: its polygons as they are, and the surface they make.

Vertices are joined (native/src/mesh/welding.h), and meshes cut (native/src/mesh/cutting.h), inside the surface alone.
"""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np

from .. import _native
from ..core.array_types import FilePath, Integers, Reals
from . import checked_mesh
from .surface import Surface


class Intake(NamedTuple):
    """surface : as `Surface.read` gives it
    vertices, corner_vertices, face_offsets : the polygons of the file that the surface has, of all vertices unless some
        faces were left out
    has_more : whether an OBJ file has UVs, materials, colours of vertices, or several objects
    """

    surface: Surface
    vertices: Reals
    corner_vertices: Integers
    face_offsets: Integers
    has_more: bool


def read(path: FilePath, up: str | None = None) -> Intake:
    """Reads a file as `Surface.read` does, and raises what it raises."""
    file = _native.FileMesh.read(os.fspath(path), False)
    vertices, corners, has_more = file.vertices, file.corner_vertices, file.has_more
    if len(file.corner_index):  # of the corners that were read
        corners = np.zeros(file.corner_index[-1] + 1, np.int64)
        corners[file.corner_index] = file.corner_vertices
    surface = Surface._of(*checked_mesh.of_read(file, path, False, up))
    corners, offsets = _polygons(corners, surface)
    if surface.refused:
        used, corners = np.unique(corners, return_inverse=True)
        vertices = vertices[used]
    return Intake(surface, vertices, corners.astype(np.int32).ravel(), offsets, has_more)


def _polygons(corners, surface):
    """(corner_vertices, face_offsets) of the surface's faces: corners that are one in it stay several where their
    vertices are."""
    count = len(surface.face_offsets) - 1
    face = np.repeat(np.arange(count), np.diff(surface.face_offsets))
    own, kept = surface._origin.repeated.T
    index = np.concatenate([surface.corner_index, own])
    face = np.concatenate([face, face[np.searchsorted(surface.corner_index, kept)]])[np.argsort(index)]
    vertices = corners[np.sort(index)]
    sizes = np.bincount(face, minlength=count)
    before = np.arange(len(vertices)) - 1
    before[np.cumsum(sizes) - sizes] += sizes
    stays = vertices != vertices[before]
    return vertices[stays], np.concatenate([[0], np.cumsum(np.bincount(face[stays], minlength=count))]).astype(np.int32)


def upright(points: Reals, up: str) -> Reals:
    """(..., 3) points with the axis `up`, "Y" or "Z", as third one."""
    return points if up == "Z" else points[..., [0, 2, 1]] * np.array([1, -1, 1])
