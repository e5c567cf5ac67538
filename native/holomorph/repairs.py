"""What was wrong with a mesh, and handled or left out."""

from dataclasses import dataclass

import numpy as np

from .array_types import Integers
from .value import Value, counted


@dataclass(frozen=True, eq=False, repr=False)
class Refused(Value):
    """A connected component that is no surface and was left out.

    Attributes
    ----------
    faces : indices of its faces in the mesh as given
    reason : one sentence that names its first bad element
    """

    faces: Integers
    reason: str

    def _facts(self):
        return [f"{counted(len(self.faces), 'face')}: {self.reason}"]


@dataclass(frozen=True, eq=False, repr=False)
class Repairs(Value):
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

    reversed_faces: Integers
    zero_area_faces: Integers
    isolated_vertices: Integers
    split_vertices: Integers
    mollification: float

    def _facts(self):
        counts = {name: len(value) for name, value in vars(self).items() if np.ndim(value)}
        facts = [f"{count} {name.replace('_', ' ')}" for name, count in counts.items() if count]
        return facts + [f"mollification {self.mollification:.2g}"] * (self.mollification != 0) or ["none"]

    def __bool__(self) -> bool:
        return any(np.any(value) if np.ndim(value) == 0 else len(value) for value in vars(self).values())
