"""What was wrong with a mesh, and handled or left out."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Refused:
    """A connected component that is no surface and was left out.

    Attributes
    ----------
    faces : indices of its faces in the mesh as given
    reason : one sentence that names its first bad element
    """

    faces: np.ndarray
    reason: str


@dataclass(frozen=True, eq=False)
class Repairs:
    """What was wrong with the input and handled inside; the input itself is never changed. Indices are those of the
    mesh as given.

    Attributes
    ----------
    reversed_faces : indices of polygons read in reverse, so that each component is oriented consistently
    zero_area_faces : indices of polygons with a triangle whose corners lie on a line
    isolated_vertices : indices of vertices of no polygon
    split_vertices : indices of vertices where fans of faces touch, of which each got a vertex of its own
    mollification : added to the lengths of edges at degenerate triangles, in the unit of the positions; 0 if there are
        none (Sharp & Crane 2020, doi:10.1111/cgf.14069). The intrinsic Delaunay triangulation that invariants come from
        needs less, mostly none
    """

    reversed_faces: np.ndarray
    zero_area_faces: np.ndarray
    isolated_vertices: np.ndarray
    split_vertices: np.ndarray
    mollification: float

    def __bool__(self):
        return any(np.any(value) if np.ndim(value) == 0 else len(value) for value in vars(self).values())
