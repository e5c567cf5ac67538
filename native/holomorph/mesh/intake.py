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
    vertices, corners, index, has_more = file.vertices, file.corner_vertices, file.corner_index, file.has_more
    surface = Surface._of(*checked_mesh.of_read(file, path, False, up))
    corners = corners[np.searchsorted(index, surface.corner_index) if len(index) else surface.corner_index]
    if surface.refused:
        used, corners = np.unique(corners, return_inverse=True)
        vertices = vertices[used]
    return Intake(surface, vertices, corners.astype(np.int32).ravel(), surface.face_offsets, has_more)


def upright(points: Reals, up: str) -> Reals:
    """(..., 3) points with the axis `up`, "Y" or "Z", as third one."""
    return points if up == "Z" else points[..., [0, 2, 1]] * np.array([1, -1, 1])
