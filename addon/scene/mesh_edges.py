# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges of Blender's meshes, named by their two vertices: their marks, such as seams, and their directions."""

import numpy as np

from .. import compatibility
from ..compatibility import Values
from . import mesh_io


def marked_edges(mesh, mark):
    """(n, 2) vertices of the edges with this mark: "use_seam", "use_edge_sharp" or "select"."""
    return _edge_vertices(mesh)[mesh_io.read_values(_marks(mesh, mark))].astype(np.int64)


def mark_edges(mesh, mark, vertex_pairs):
    """Gives the edges between these (n, 2) vertices the mark, and no other edge."""
    mesh_io.write_values(_marks(mesh, mark), _edges_between(mesh, vertex_pairs))


def read_seams(mesh):
    """(#mesh edges,) bool."""
    return mesh_io.read_values(_marks(mesh, "use_seam"))


def add_seams(mesh, vertex_pairs):
    """Marks the edges with these (#S,2) vertices as seams, keeps every seam there is; returns how many are new."""
    wanted = _edges_between(mesh, vertex_pairs)
    before = read_seams(mesh)
    mesh_io.write_values(_marks(mesh, "use_seam"), before | wanted)
    return int(np.count_nonzero(wanted & ~before))


def are_neighbours(mesh, vertices):
    """Whether some edge joins two of the vertices."""
    return bool(np.isin(_edge_vertices(mesh), vertices).all(axis=1).any())


def edge_vectors(mesh, vertex_pairs):
    """(n, 3) from the first to the second of (n, 2) vertices."""
    positions = mesh_io.read_values(compatibility.position_values(mesh)).astype(np.float64)
    return positions[vertex_pairs[:, 1]] - positions[vertex_pairs[:, 0]]


def _edge_vertices(mesh):
    return mesh_io.read_indices(compatibility.edge_vertex_values(mesh))


def _marks(mesh, mark):
    return Values(mesh.edges, mark, bool)


def _edges_between(mesh, vertex_pairs):
    """(#mesh edges,) bool: the edges whose vertices are one of the pairs."""
    ends = np.sort(_edge_vertices(mesh), axis=1)
    pairs = np.sort(np.asarray(vertex_pairs, np.int64).reshape(-1, 2), axis=1)
    count = len(mesh.vertices)
    return np.isin(ends[:, 0].astype(np.int64) * count + ends[:, 1], pairs[:, 0] * count + pairs[:, 1])
