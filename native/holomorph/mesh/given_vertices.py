"""Vertices of a mesh as given, on one part of it."""

import numpy as np


def on_part(part, vertices):
    """((n, ...) the part's index of each of these vertices of the mesh as given, any where it has none; (n, ...) bool,
    whether it has the vertex). O((#V + n) log #V)."""
    index = part.vertex_index
    order = np.argsort(index, kind="stable")
    vertices = np.asarray(vertices, np.int64)
    places = order[np.searchsorted(index, vertices, sorter=order).clip(max=len(order) - 1)]
    return places, index[places] == vertices
