"""Energies of given forms in interval arithmetic of 200 bits (Arb), an oracle that shares nothing with the core.

Every number is an interval that holds the exact one; doubles are taken as they are.
"""

import numpy as np
from flint import arb, arb_mat, ctx

BITS = 200
ctx.prec = BITS


def exact(array):
    """Doubles or integers as intervals of no width."""
    return np.vectorize(arb, otypes=[object])(np.asarray(array, dtype=float))


def gram(points, triangles, classes, functions):
    """Gram matrix, an `arb_mat`, of the forms eta + d f on embedded triangles: (#T, 3, m) integers eta along the sides,
    (#V, m) functions f. Each is (p, q) on a triangle with sides s, t from corner 0, and |.|^2 is that of its gradient.
    """
    corners = exact(points)[triangles]
    s, t = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    ss, st, tt = (s * s).sum(axis=1), (s * t).sum(axis=1), (t * t).sum(axis=1)
    at_corners = exact(functions)[triangles]
    values = np.roll(at_corners, -1, axis=1) - at_corners + exact(classes)
    p, q = values[:, 0], -values[:, 2]
    double_area = np.vectorize(lambda x: x.sqrt(), otypes=[object])(ss * tt - st * st)[:, None]
    dual_p = (tt[:, None] * p - st[:, None] * q) / double_area / 2
    dual_q = (ss[:, None] * q - st[:, None] * p) / double_area / 2
    return arb_mat((p.T.dot(dual_p) + q.T.dot(dual_q)).tolist())


def imaginary_bounds(form, canonical_cycles):
    """(lower, upper) of Im Omega by its formulas, (G_bb)^-1 and G_aa - G_ab (G_bb)^-1 G_ba."""
    classes = arb_mat(np.rint(np.linalg.inv(canonical_cycles).T).astype(int).tolist())
    table = np.array((classes * form * classes.transpose()).tolist(), dtype=object)
    g = len(table) // 2
    (aa, ab), (ba, bb) = (
        [arb_mat(table[rows, columns].tolist()) for columns in (slice(g), slice(g, None))]
        for rows in (slice(g), slice(g, None))
    )
    return bb.inv(), aa - ab * bb.inv() * ba


def is_positive(form):
    """Whether a symmetric form is certainly positive definite: the pivots of its elimination are."""
    rows = np.array(form.tolist(), dtype=object)
    for i in range(len(rows)):
        if not rows[i, i] > 0:
            return False
        rows[i + 1 :] = rows[i + 1 :] - np.outer(rows[i + 1 :, i] / rows[i, i], rows[i])
    return True


def of_doubles(matrix):
    return arb_mat(exact(matrix).tolist())
