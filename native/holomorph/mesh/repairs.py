"""What was wrong with a mesh, and handled or left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.array_types import Integers
from ..core.value import Value, counted

# By the reason of a cut: what is said of one element, and of several.
SENTENCES = {
    "many_faces": ("cut along 1 edge that has three or more faces", "cut along {} edges that have three or more faces"),
    "twice": ("1 face occurs twice: its copy is separate", "{} faces occur twice: their copies are separate"),
    "opposite": ("1 face has two sides: each is separate", "{} faces have two sides: each side is separate"),
    "one_sided": (
        "cut along 1 edge of a part that has only one side",
        "cut along {} edges of parts that have only one side",
    ),
    "repeated": ("1 face meets a vertex twice: it is separate", "{} faces meet a vertex twice: they are separate"),
    "touching": (
        "cut at 1 vertex where faces touch without a common edge",
        "cut at {} vertices where faces touch without a common edge",
    ),
}


@dataclass(frozen=True, eq=False, repr=False)
class Refused(Value):
    """Faces that were left out for one reason.

    Attributes
    ----------
    faces : their indices in the mesh as given
    reason : one sentence that names the first bad element
    """

    faces: Integers
    reason: str

    def _facts(self):
        return [f"{counted(len(self.faces), 'face')}: {self.reason}"]


@dataclass(frozen=True, eq=False, repr=False)
class Cut(Value):
    """All cuts of a mesh for one reason. Indices are those of the mesh as given; two of the arrays are empty.

    Attributes
    ----------
    reason : "many_faces", edges with three faces or more: those that continue each other best are joined in pairs;
        "twice", faces on the vertices of an earlier one, and "opposite", those that run the other way round, which form
        sheets of their own; "one_sided", edges at which no orientation of their faces fits; "repeated", faces that meet
        a vertex more than once, apart from all others; "touching", vertices at which fans of faces touch, each of which
        has its own
    vertices : (n,) of "touching"
    edges : (n, 2) vertices, lower first, of "many_faces" and "one_sided"
    faces : (n,) of the other reasons
    """

    reason: str
    vertices: Integers
    edges: Integers
    faces: Integers

    @property
    def count(self) -> int:
        """The number of elements."""
        return len(self.vertices) + len(self.edges) + len(self.faces)

    @property
    def sentence(self) -> str:
        """What was cut and why, as part of a sentence."""
        one, many = SENTENCES[self.reason]
        return one if self.count == 1 else many.format(f"{self.count:,}")

    def _facts(self):
        return [self.sentence]


@dataclass(frozen=True, eq=False, repr=False)
class Repairs(Value):
    """What was wrong with the input and handled inside; the input itself is never changed. Indices are those of the
    mesh as given.

    Attributes
    ----------
    reversed_faces : indices of polygons read in reverse, so that each component is oriented consistently
    zero_area_faces : indices of polygons with a triangle whose corners lie on a line
    isolated_vertices : indices of vertices of no polygon
    cuts : one `Cut` for each reason for which the mesh was cut until it was a surface
    joined_vertices : indices of vertices that were joined with a lower one at the same place, where faces that lie
        side by side were apart
    mollification : added to the lengths of edges at degenerate triangles, in the unit of the positions; 0 if there are
        none (Sharp & Crane 2020, doi:10.1111/cgf.14069). The intrinsic Delaunay triangulation that invariants come from
        needs less, mostly none
    notes : sentences about what is wrong with the file, although the rest of it was read
    """

    reversed_faces: Integers
    zero_area_faces: Integers
    isolated_vertices: Integers
    cuts: tuple[Cut, ...]
    joined_vertices: Integers
    mollification: float
    notes: tuple[str, ...] = ()

    def _facts(self):
        counts = {name: len(value) for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        facts = [f"{count} {name.replace('_', ' ')}" for name, count in counts.items() if count]
        facts += [*(cut.sentence for cut in self.cuts), *self.notes]
        return facts + [f"mollification {self.mollification:.2g}"] * (self.mollification != 0) or ["none"]

    def __bool__(self) -> bool:
        return self.mollification != 0 or any(len(value) for value in vars(self).values() if np.iterable(value))
