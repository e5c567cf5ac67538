"""Period matrices' bounds in 200 bits, step by step and for small meshes: an oracle that shares nothing with the core.

Everything is `decimal.Decimal`. Classes and loops are taken from a structure as integers, lengths from its input.
"""

from decimal import Decimal, getcontext

import numpy as np

DIGITS = 61  # 200 bits
getcontext().prec = DIGITS


def exact(array):
    """Doubles as decimals, without rounding."""
    return np.vectorize(Decimal, otypes=[object])(np.asarray(array))


def squared_sides(points, triangles):
    """(#T, 3) squares of the lengths, side i from corner i to corner i + 1, of positions."""
    corners = exact(points)[triangles]
    steps = np.roll(corners, -1, axis=1) - corners
    return (steps**2).sum(axis=2)


def cotangents(squares):
    """(#T, 3) of the angle opposite each side."""
    a, b, c = squares.T
    # Heron: 16 A^2 = 4 a b - (a + b - c)^2 of squared lengths; c^2 = a^2 + b^2 - 2 a b cos, so cot = (a + b - c) / 4 A.
    area = np.array([root.sqrt() for root in 4 * a * b - (a + b - c) ** 2])
    return np.stack([(b + c - a) / area, (a + c - b) / area, (a + b - c) / area], axis=1)


def solved(matrix, right):
    """Gauss-Jordan elimination with pivots, of decimals."""
    rows = np.concatenate([matrix, right], axis=1).copy()
    n = len(matrix)
    for i in range(n):
        pivot = i + max(range(n - i), key=lambda k: abs(rows[i + k, i]))
        rows[[i, pivot]] = rows[[pivot, i]]
        rows[i] = rows[i] / rows[i, i]
        for k in range(n):
            if k != i and rows[k, i] != 0:
                rows[k] = rows[k] - rows[k, i] * rows[i]
    return rows[:, n:]


def integer_classes(triangles, values):
    """(#T, 3, m) closed integer forms in the classes of the closed forms with these values on the sides, whose periods
    are integers: integrated along a tree, what is left is an integer."""
    potential = np.full((triangles.max() + 1, values.shape[2]), np.nan)
    potential[triangles[0, 0]] = 0
    tails, heads = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    steps = values.reshape(len(tails), -1)
    while np.isnan(potential).any():
        known = ~np.isnan(potential[tails, 0])
        potential[heads[known]] = potential[tails[known]] + steps[known]
    left = values - (potential[np.roll(triangles, -1, axis=1)] - potential[triangles])
    integers = np.rint(left).astype(int)
    assert np.abs(left - integers).max() < 1e-6
    assert not integers.sum(axis=1).any()
    return integers


def least_gram(triangles, squares, classes):
    """(m, m) Gram matrix of the harmonic forms of these classes on a closed surface."""
    n, m = triangles.max() + 1, classes.shape[2]
    weights = cotangents(squares) / 2
    heads = np.roll(triangles, -1, axis=1)
    laplacian = np.full((n, n), Decimal(0))
    right = np.full((n, m), Decimal(0))
    for tail, head, weight, value in zip(
        triangles.ravel(), heads.ravel(), weights.ravel(), classes.reshape(-1, m), strict=True
    ):
        laplacian[[tail, head], [tail, head]] += weight
        laplacian[[tail, head], [head, tail]] -= weight
        flux = weight * exact(value)
        right[tail] += flux
        right[head] -= flux
    functions = np.concatenate([np.full((1, m), Decimal(0)), solved(laplacian[1:, 1:], right[1:])])
    forms = functions[heads] - functions[triangles] + exact(classes)
    return np.einsum("ti,tim,tin->mn", weights, forms, forms)


def imaginary_bounds(gram, canonical_cycles):
    """(lower, upper) of Im Omega: (G_bb)^-1 and G_aa - G_ab (G_bb)^-1 G_ba in the classes dual to canonical cycles."""
    classes = exact(np.rint(np.linalg.inv(canonical_cycles).T))
    canonical = classes.dot(gram).dot(classes.T)
    g = len(gram) // 2
    one = exact(np.eye(g))
    lower = solved(canonical[g:, g:], one)
    across = canonical[:g, g:]
    return lower, canonical[:g, :g] - across.dot(lower).dot(across.T)


def difference(decimals, doubles):
    """decimals - doubles, rounded only then."""
    return (decimals - exact(doubles)).astype(float)
