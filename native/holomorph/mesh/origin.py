"""What a surface is of the mesh as given."""

from typing import NamedTuple

import numpy as np

from ..core import arrays
from ..core.array_types import Integers
from .edges import are_among
from .repairs import Cut, Refused, Repairs

NO_FACES = arrays.frozen(np.empty(0, np.int32))
NO_PAIRS = arrays.frozen(np.empty((0, 2), np.int32))


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
        return cls(
            part.vertex_index,
            part.face_index,
            part.corner_index,
            part.given_vertex_count,
            tuple(Cut(*cut) for cut in part.cuts),
            arrays.frozen(np.array(part.joined_vertices, np.int32).reshape(-1, 2)),
            tuple(Refused(*entry) for entry in part.refused),
            arrays.frozen(np.array(part.repeated_corners, np.int32).reshape(-1, 2)),
            part.point_faces,
            tuple(part.notes),
            up,
        )

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
        return Repairs(
            _in_mesh(self.face_index, native.reversed_faces),
            _joined_faces(_in_mesh(self.face_index, native.zero_area_faces), self.point_faces),
            _in_mesh(self.vertex_index, native.isolated_vertices),
            self.cuts,
            arrays.frozen(self.joined[:, 0]),
            native.mollification(),
            self.notes,
        )


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
