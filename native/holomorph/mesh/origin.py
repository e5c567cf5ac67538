"""What a surface is of the mesh as given; what was wrong with that, and handled or left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core import arrays
from ..core.array_types import Integers
from ..core.value import Value, counted
from .edges import are_among

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
NO_FACES = arrays.frozen(np.empty(0, np.int32))
NO_PAIRS = arrays.frozen(np.empty((0, 2), np.int32))


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


class Origin(NamedTuple):
    """Indices of a surface's elements in the mesh as given, None where they are numbered as in it; and what of the mesh
    was cut, joined and left out."""

    vertex_index: Integers | None = None
    face_index: Integers | None = None
    corner_index: Integers | None = None
    vertex_count: int | None = None  # the mesh's; None for that of the surface
    cuts: tuple[Cut, ...] = ()
    joined: Integers = NO_PAIRS  # (n, 2) vertices that were joined with a lower one, ascending, and that one
    refused: tuple[Refused, ...] = ()
    repeated: Integers = NO_PAIRS  # (n, 2) corners that go, with the one of their face that stands for each
    point_faces: Integers = NO_FACES  # that go, since their corners lie at one or two places
    notes: tuple[str, ...] = ()  # about the file
    up: str = "Z"  # see `Surface.up`

    @classmethod
    def of_part(cls, part, up="Z"):
        """The `Origin` of the surface in a native part of a mesh."""
        indices = part.vertex_index, part.face_index, part.corner_index, part.given_vertex_count
        cuts, refused = tuple(Cut(*cut) for cut in part.cuts), tuple(Refused(*entry) for entry in part.refused)
        pairs = part.joined_vertices, part.repeated_corners
        joined, repeated = (arrays.frozen(np.array(each, np.int32).reshape(-1, 2)) for each in pairs)
        return cls(*indices, cuts, joined, refused, repeated, part.point_faces, tuple(part.notes), up)

    def of_component(self, part, vertex_count):
        """The `Origin` of a native part of the surface, in a mesh with this number of vertices."""
        indices = self.vertex_index, self.face_index, self.corner_index
        own = part.vertex_index, part.face_index, part.corner_index
        vertex_index, *others = map(_in_mesh, indices, own)
        joined, repeated = _led_to(self.joined, vertex_index), _led_to(self.repeated, others[-1])
        return Origin(vertex_index, *others, vertex_count, joined=joined, repeated=repeated, up=self.up)

    def lowest(self, vertices):
        """Vertices of the mesh as given; of those that were joined, the one that stands for them."""
        if not len(self.joined):
            return vertices
        own, into = self.joined.T
        places = np.searchsorted(own, vertices).clip(max=len(own) - 1)
        return np.where(own[places] == vertices, into[places], vertices)

    def repairs(self, native):
        """The `Repairs` of the native surface."""
        turned, flat = (_in_mesh(self.face_index, each) for each in (native.reversed_faces, native.zero_area_faces))
        isolated, joined = _in_mesh(self.vertex_index, native.isolated_vertices), arrays.frozen(self.joined[:, 0])
        flat = _joined_faces(flat, self.point_faces)
        return Repairs(turned, flat, isolated, self.cuts, joined, native.mollification(), self.notes)


AS_GIVEN = Origin()


def _led_to(pairs, own):
    """The pairs whose second element is among these."""
    return arrays.frozen(pairs[np.isin(pairs[:, 1], own)]) if len(pairs) else pairs


def _joined_faces(one, other):
    return arrays.frozen(np.sort(np.concatenate([one, other]))) if len(other) else one


def _in_mesh(index, elements):
    return elements if index is None else arrays.frozen(index[elements])


def on_part(part, vertices):
    """((n, ...) the part's index of each of these vertices of the mesh as given, any where it has none; (n, ...) bool,
    whether it has the vertex). O((#V + n) log #V)."""
    vertices, index = part._origin.lowest(np.asarray(vertices, np.int64)), part.vertex_index
    if not vertices.size:
        return vertices, vertices.astype(bool)
    order = np.argsort(index, kind="stable")
    places = order[np.searchsorted(index, vertices, sorter=order).clip(max=len(order) - 1)]
    return places, index[places] == vertices


def edges_on_part(part, ends):
    """(k, 2) the part's vertices of its edges that have these ends, (n, 2) vertices of the mesh as given."""
    edges, count = np.asarray(part._native.edges), part.given_vertex_count
    return edges[are_among(part.vertex_index[edges], part._origin.lowest(np.asarray(ends, np.int64)), count)]
