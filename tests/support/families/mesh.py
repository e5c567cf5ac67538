"""What a mesh is, for the families; connected components, for the generators and for independent counts."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Mixed polygons. `topology` has (genus, boundary loops) of each component, in the order of their first faces."""

    vertices: np.ndarray
    corners: np.ndarray
    offsets: np.ndarray
    topology: tuple = ()

    @property
    def genus(self):
        ((genus, _),) = self.topology
        return genus

    @property
    def boundary_count(self):
        ((_, boundaries),) = self.topology
        return boundaries

    @property
    def face_count(self):
        return len(self.offsets) - 1

    @property
    def faces(self):
        """One array per polygon: for the tests that need lists, not for large meshes."""
        return np.split(self.corners, self.offsets[1:-1])


@dataclass(frozen=True)
class FlatSurface:
    """Triangles and edge lengths: an intrinsic surface. Entry i of a row belongs to the side opposite corner i."""

    faces: np.ndarray
    edge_lengths: np.ndarray
    face_edges: np.ndarray
    genus: int


def uniform(vertices, faces, topology=()):
    """A mesh whose polygons all have the same number of corners: `faces` (#F, n)."""
    faces = np.asarray(faces, dtype=np.int64)
    return Mesh(np.asarray(vertices, dtype=float), faces.ravel(), np.arange(len(faces) + 1) * faces.shape[1], topology)


def polygons(vertices, faces, topology=()):
    """A mesh from a list of lists: for small ones."""
    sizes = [len(face) for face in faces]
    corners = np.array([vertex for face in faces for vertex in face], dtype=np.int64)
    return Mesh(np.asarray(vertices, dtype=float), corners, np.cumsum([0, *sizes]), topology)


def components(n, a, b):
    """The smallest node of each node's component, in the graph of n nodes with edges a[k] - b[k]."""
    label = np.arange(n)
    a, b = np.ravel(a), np.ravel(b)
    while True:
        low, high = np.minimum(label[a], label[b]), np.maximum(label[a], label[b])
        if (low == high).all():
            return label
        np.minimum.at(label, high, low)
        while (label[label] != label).any():
            label = label[label]
