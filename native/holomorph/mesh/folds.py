"""Where a surface is folded over itself, so that no map of it looks right."""

import numpy as np

from .. import _native
from .hard_edges import is_hard

SHARP = 150.0  # degrees between the normals of two faces: a fold, or a blade


def folds(surface, threads=0):
    """(#E,) whether an edge bends by more than `SHARP`, and a face beside it goes through another one. Blades and
    sheets with two sides bend, and do not cross."""
    result = np.zeros(len(surface._native.edges), bool)
    sharp = np.flatnonzero(is_hard(surface, SHARP))
    if len(sharp):
        crossing = np.unique(_native.crossings(surface.vertices, surface.triangles, threads=threads))
        result[sharp] = np.isin(sharp, surface._native.triangle_edges[crossing])
    return result
