"""Takes a native surface to the arrays that it is made of, and back, with the same bits."""

import numpy as np

from .. import _native


def arrays_of(native):
    """(vertices, corner vertices, face offsets), or of an intrinsic surface (number of vertices, faces, edge lengths,
    names of edges), (#F, 3) each, as `Surface.from_edge_lengths` takes them."""
    if not native.intrinsic:
        return tuple(np.array(part) for part in (native.vertices, native.corner_vertices, native.face_offsets))
    names = np.empty(len(native.corner_vertices), np.int64)
    names[native.triangle_corners] = native.triangle_edges[:, [1, 2, 0]]  # the edge opposite each corner
    faces = native.corner_vertices.astype(np.int64).reshape(-1, 3)
    names = names.reshape(-1, 3)
    return native.vertex_count, faces, native.edge_lengths[names], names


def native_of(made_of):
    """The native surface of `arrays_of`."""
    if len(made_of) == 3:
        return _native.Surface.from_polygons(*made_of)
    return _native.Surface.from_edge_lengths(*made_of)
