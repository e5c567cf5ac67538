"""Genus and boundary loops of polygon meshes by counting, independently of the library: manifold meshes only."""

import numpy as np
from families import components


def sides(mesh):
    """From and to vertex of every side of every polygon, in the order of the corners."""
    following = np.arange(1, len(mesh.corners) + 1)
    following[mesh.offsets[1:] - 1] = mesh.offsets[:-1]
    return mesh.corners.astype(np.int64), mesh.corners[following].astype(np.int64)  # for keys like from * #V + to


def face_of_corner(mesh):
    return np.repeat(np.arange(mesh.face_count), np.diff(mesh.offsets))


def undirected_edges(mesh):
    """(#E, 2) ends, and for every corner the edge that starts there."""
    ends = np.sort(np.stack(sides(mesh), axis=1), axis=1)
    n = len(mesh.vertices)
    key, edge = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    return np.stack([key // n, key % n], axis=1), edge


def face_components(mesh):
    """Component of each polygon (of polygons that share a vertex), numbered by first polygon."""
    label = components(len(mesh.vertices), *sides(mesh))[mesh.corners[mesh.offsets[:-1]]]
    _, first, number = np.unique(label, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[number]


def topology(mesh):
    """(genus, boundary loops) of every component, in the order of their first polygons."""
    edges, edge_of_corner = undirected_edges(mesh)
    open_edges = edges[np.bincount(edge_of_corner) == 1]
    component_of_face = face_components(mesh)
    component_of_vertex = np.full(len(mesh.vertices), -1)
    component_of_vertex[mesh.corners] = component_of_face[face_of_corner(mesh)]
    count = component_of_face.max() + 1
    loop = components(len(mesh.vertices), open_edges[:, 0], open_edges[:, 1])[open_edges[:, 0]]
    boundaries = np.bincount(component_of_vertex[np.unique(loop)], minlength=count)
    used = component_of_vertex[component_of_vertex >= 0]
    chi = np.bincount(used) - np.bincount(component_of_vertex[edges[:, 0]]) + np.bincount(component_of_face)
    return tuple(zip(((2 - boundaries - chi) // 2).tolist(), boundaries.tolist(), strict=True))
