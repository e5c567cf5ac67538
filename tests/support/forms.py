"""One-forms on the edges of a surface's triangulation, in NumPy: what the library's results are checked against."""

import numpy as np


class EdgeForms:
    """Values of forms (#forms, #E) along directed edges, for surfaces in which two vertices share at most one edge."""

    def __init__(self, edges, vertex_count):
        self.vertex_count = vertex_count
        self.edges = np.asarray(edges, dtype=np.int64)
        keys = self.edges @ [vertex_count, 1]
        self.order = np.argsort(keys)
        self.keys = keys[self.order]
        assert (np.diff(self.keys) > 0).all(), "two edges share both ends"

    def index(self, start, end):
        """Edges from `start` to `end`, and the sign of that direction; every one of them must be an edge."""
        keys = np.minimum(start, end).astype(np.int64) * self.vertex_count + np.maximum(start, end)
        place = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        assert (self.keys[place] == keys).all(), "no such edge"
        return self.order[place], np.where(start < end, 1, -1)

    def along(self, forms, start, end):
        edge, sign = self.index(start, end)
        return forms[:, edge] * sign

    def integrals(self, forms, loops):
        """(#forms, #loops) integrals over closed loops of vertices."""
        return np.stack([self.along(forms, loop, np.roll(loop, -1)).sum(axis=1) for loop in loops], axis=1)


def edge_forms(structure):
    return EdgeForms(structure.edges, len(structure.surface.vertices))


def on_triangle_sides(structure, forms):
    """(#forms, #T, 3): values along side i of each triangle, from corner i to the next."""
    triangles = structure.surface.triangles
    return edge_forms(structure).along(forms, triangles, np.roll(triangles, -1, axis=1))


def wedge_matrix(structure, forms):
    """Integrals of w_i ^ w_j over the surface."""
    sides = on_triangle_sides(structure, forms)
    product = np.einsum("it,jt->ij", sides[:, :, 0], sides[:, :, 1], optimize=True)
    return (product - product.T) / 2


def cotangents(points, triangles):
    """(#T, 3) cotangents of the angles at the corners."""
    p = points[triangles]
    to, on = np.roll(p, -1, axis=1) - p, np.roll(p, -2, axis=1) - p
    return (to * on).sum(axis=2) / np.linalg.norm(np.cross(to, on), axis=2)


def edge_weights(structure):
    """(#E,) k = (cot a + cot b) / 2 on the input triangulation."""
    surface = structure.surface
    cot = cotangents(surface.vertices, surface.triangles)
    edge, _ = edge_forms(structure).index(
        np.roll(surface.triangles, -1, axis=1), np.roll(surface.triangles, -2, axis=1)
    )
    return np.bincount(edge.ravel(), cot.ravel() / 2, minlength=len(structure.edges))


def energy_matrix(structure, forms):
    """Sum over the edges of k w_i w_j, on the input triangulation."""
    return (forms * edge_weights(structure)) @ forms.T


def symplectic_change(structure, other, old_vertex=None):
    """M with zeta'_i = sum_j M_ij zeta_j: the loops of `other` measured by the forms of `structure`.
    `old_vertex` gives the vertex of `structure` for each vertex of `other`."""
    loops = other.homology_basis
    if old_vertex is not None:
        loops = [old_vertex[loop] for loop in loops]
    return edge_forms(structure).integrals(structure.harmonic_forms, loops).T


def determinant(matrix):
    """The determinant of integers, exactly (Bareiss)."""
    rows = [[int(entry) for entry in row] for row in matrix]
    sign, previous = 1, 1
    for k in range(len(rows) - 1):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k]), None)
        if pivot is None:
            return 0
        if pivot != k:
            rows[k], rows[pivot], sign = rows[pivot], rows[k], -sign
        for i in range(k + 1, len(rows)):
            for j in range(k + 1, len(rows)):
                rows[i][j] = (rows[i][j] * rows[k][k] - rows[i][k] * rows[k][j]) // previous
        previous = rows[k][k]
    return sign * rows[-1][-1]
