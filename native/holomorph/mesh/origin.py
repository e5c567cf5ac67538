"""What a surface is of the mesh as given."""

from typing import NamedTuple

import numpy as np

from ..core import arrays
from ..core.array_types import Integers
from .repairs import Cut, Refused, Repairs

NO_VERTICES = arrays.frozen(np.empty(0, np.int32))


class Origin(NamedTuple):
    """Indices of a surface's elements in the mesh as given, None where they are numbered as in it; and what of the mesh
    was cut, joined and left out."""

    vertex_index: Integers | None = None
    face_index: Integers | None = None
    corner_index: Integers | None = None
    vertex_count: int | None = None  # the mesh's; None for that of the surface
    cuts: tuple[Cut, ...] = ()
    joined_vertices: Integers = NO_VERTICES
    refused: tuple[Refused, ...] = ()
    notes: tuple[str, ...] = ()  # about the file

    @classmethod
    def of_part(cls, part):
        """The `Origin` of the surface in a native part of a mesh."""
        return cls(
            part.vertex_index,
            part.face_index,
            part.corner_index,
            part.given_vertex_count,
            tuple(Cut(cut.reason.name, cut.vertices, cut.edges, cut.faces) for cut in part.cuts),
            arrays.frozen(np.array(part.joined_vertices, np.int32)),
            tuple(Refused(entry.faces, entry.reason) for entry in part.refused),
            tuple(part.notes),
        )

    def of_component(self, part, vertex_count):
        """The `Origin` of a native part of the surface, in a mesh with this number of vertices."""
        indices = self.vertex_index, self.face_index, self.corner_index
        own = part.vertex_index, part.face_index, part.corner_index
        return Origin(*map(_in_mesh, indices, own), vertex_count)

    def repairs(self, native):
        """The `Repairs` of the native surface."""
        return Repairs(
            _in_mesh(self.face_index, native.reversed_faces),
            _in_mesh(self.face_index, native.zero_area_faces),
            _in_mesh(self.vertex_index, native.isolated_vertices),
            self.cuts,
            self.joined_vertices,
            native.mollification(),
            self.notes,
        )


AS_GIVEN = Origin()


def _in_mesh(index, elements):
    return elements if index is None else arrays.frozen(index[elements])


def on_part(part, vertices):
    """((n, ...) the part's index of each of these vertices of the mesh as given, any where it has none; (n, ...) bool,
    whether it has the vertex). O((#V + n) log #V)."""
    index = part.vertex_index
    order = np.argsort(index, kind="stable")
    vertices = np.asarray(vertices, np.int64)
    places = order[np.searchsorted(index, vertices, sorter=order).clip(max=len(order) - 1)]
    return places, index[places] == vertices
