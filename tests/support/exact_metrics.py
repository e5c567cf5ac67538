"""Surfaces whose metric is known exactly, and in intervals of 200 bits what rounding makes of it."""

import families
import numpy as np
from flint import arb_mat
from holomorph import _native
from interval_energies import exact, of_doubles

UNIT = 2.0**-53
_root = np.vectorize(lambda x: x.sqrt(), otypes=[object])
_middle = np.vectorize(float, otypes=[float])


def torus_of_two(lengths, errors=0.0):
    """Two congruent triangles with sides `lengths`, glued to a torus of one vertex: the native surface, whose faces
    stand for others with these `errors`, and the classes on sides of two forms, (1, 0) and (0, 1) on the sides opposite
    corners 0 and 1."""
    sides = np.tile(np.asarray(lengths, float), (2, 1))
    names = np.tile(np.arange(3), (2, 1))
    surface = _native.refined_surface(1, np.zeros((2, 3), np.int64), sides, names, np.full(2, float(errors)))
    along = np.array([[-1, -1], [1, 0], [0, 1]], np.int32).ravel()  # from corner 0 to 1, 1 to 2, 2 to 0
    return surface, np.array([along, -along])


def hexagonal_torus(n, errors=None):
    """A flat torus of 2 n^2 triangles with sides of 1: the native surface, as in `torus_of_two`, and its faces. The
    edges at vertex 0 have the lowest numbers, then come the diagonals."""
    faces = families.cut_quads(families.grid_quads(n, n))
    ends = np.sort(np.stack([np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1)], axis=-1), axis=-1)
    known, names = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    away = (known[:, 1] - known[:, 0]) % n * n + (known[:, 1] // n - known[:, 0] // n) % n
    is_diagonal = np.isin(away, [n + 1, (n - 1) * n + n - 1])
    rank = np.empty(len(known), int)
    rank[np.argsort(np.where((known == 0).any(axis=1), 0, np.where(is_diagonal, 1, 2)), kind="stable")] = np.arange(
        len(known)
    )
    of_faces = np.zeros(len(faces)) if errors is None else errors
    surface = _native.refined_surface(
        n * n, faces.astype(np.int64), np.ones(faces.shape), rank[names].reshape(-1, 3), of_faces
    )
    return surface, faces


def gram(lengths, faces, classes, functions, growth=None):
    """As `interval_energies.gram`, of triangles with these exact lengths, opposite their corners; the energy on each
    times 1 + `growth`."""
    squares = exact(lengths) * exact(lengths)
    ss, tt, st, area = _plane(squares)
    at_corners = exact(functions)[faces]
    values = np.roll(at_corners, -1, axis=1) - at_corners + exact(classes)
    p, q = values[:, 0], -values[:, 2]
    scale = (1 if growth is None else 1 + exact(growth)) / (2 * _root(area))
    dual_p = (tt * scale)[:, None] * p - (st * scale)[:, None] * q
    dual_q = (ss * scale)[:, None] * q - (st * scale)[:, None] * p
    return arb_mat((p.T.dot(dual_p) + q.T.dot(dual_q)).tolist())


def _plane(squares):
    """|s|^2, |t|^2, s . t and (2 A)^2, s and t the sides from corner 0, of triangles by their squared sides."""
    ss, tt = squares[:, 2], squares[:, 1]
    st = (ss + tt - squares[:, 0]) / 2
    return ss, tt, st, ss * tt - st * st


def growth(lengths, squares):
    """By how much the energy of a form, constant on a triangle of the given `lengths`, (#T, 3) doubles, may be larger
    on the triangle with these exact `squares` of lengths, relatively. Energies have the determinant 1: with the trace t
    of their quotient the factors are x and 1 / x, x + 1 / x = t."""
    ss, tt, st, area = _plane(exact(lengths) * exact(lengths))
    true_ss, true_tt, true_st, true_area = _plane(squares)
    trace = (ss * true_tt + tt * true_ss - 2 * st * true_st) / _root(area * true_area)
    excess = np.maximum(_middle(trace - 2), 0)
    return (excess + np.sqrt(excess * (excess + 4))) / 2


def largest_part(missed, bound):
    """The largest part of a bound, in any direction, that a quadratic form is missed by."""
    root = np.linalg.inv(np.linalg.cholesky(bound))
    return np.linalg.eigvalsh(root @ missed @ root.T)[-1]


def missed(exact_gram, computed):
    """The exact form less the computed one, in doubles."""
    return np.array([[float(x) for x in row] for row in (exact_gram - of_doubles(computed)).tolist()])
