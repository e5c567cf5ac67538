"""Elements of order p in exact fractions, from their definition, and energies of functions in intervals of 200 bits."""

from fractions import Fraction
from functools import cache
from math import comb, factorial, lcm

import numpy as np
from flint import arb, arb_mat, fmpq
from interval_energies import exact


class Polynomial:
    """In x = l1 and y = l2 by exact coefficients, {(i, j): that of x^i y^j}."""

    def __init__(self, terms):
        self.terms = {powers: value for powers, value in terms.items() if value != 0}

    def __add__(self, other):
        keys = self.terms.keys() | other.terms.keys()
        return Polynomial({key: self.terms.get(key, 0) + other.terms.get(key, 0) for key in keys})

    def __mul__(self, other):
        if not isinstance(other, Polynomial):
            return Polynomial({key: other * value for key, value in self.terms.items()})
        product = {}
        for (i, j), a in self.terms.items():
            for (k, m), b in other.terms.items():
                product[i + k, j + m] = product.get((i + k, j + m), 0) + a * b
        return Polynomial(product)

    def __sub__(self, other):
        return self + other * Fraction(-1)

    def derivative(self, a, b):
        """a d/dx + b d/dy."""
        by_x = Polynomial({(i - 1, j): i * value for (i, j), value in self.terms.items()})
        by_y = Polynomial({(i, j - 1): j * value for (i, j), value in self.terms.items()})
        return by_x * a + by_y * b


ONE, X, Y = Polynomial({(0, 0): Fraction(1)}), Polynomial({(1, 0): Fraction(1)}), Polynomial({(0, 1): Fraction(1)})
CORNERS = [ONE - X - Y, X, Y]
ALONG = [(1, 0), (-1, 1), (0, -1)]  # of sides, from corner i to corner i + 1


def legendre(n, s, t):
    """t^n P_n(s / t) by Bonnet's recurrence."""
    before, value = Polynomial({}), ONE
    for k in range(n):
        value, before = (s * value * (2 * k + 1) - t * t * before * k) * Fraction(1, k + 1), value
    return value


def of_side(n, i):
    s, t = CORNERS[(i + 1) % 3] - CORNERS[i], CORNERS[(i + 1) % 3] + CORNERS[i]
    return legendre(n, s, t) - t * t * legendre(n - 2, s, t)


def jacobi(n, a):
    """P_n^(a, 1)(2 y - 1) by powers of (x - 1) / 2 = y - 1 (Szegoe 1975, 4.21.2)."""
    total, power = Polynomial({}), ONE
    for k in range(n + 1):
        value = Fraction(comb(n, k) * factorial(a + n + 1 + k), factorial(n) * (a + n + 1) * factorial(a + k))
        total, power = total + power * value, power * (Y - ONE)
    return total


def basis(order):
    functions = [X, Y, *(of_side(n, i) for i in range(3) for n in range(2, order + 1))]
    for a in range(2, order):
        functions += [of_side(a, 0) * Y * jacobi(b - 1, 2 * a - 2) for b in range(1, order - a + 1)]
    return functions


def integrals(functions, others):
    """Integrals of the products of all of these with all of those over the triangle of area 1 / 2, times a number that
    makes them integers, and that number."""
    powers = sorted({key for f in [*functions, *others] for key in f.terms})
    moments = [
        [Fraction(factorial(i + k) * factorial(j + m), factorial(i + j + k + m + 2)) for k, m in powers]
        for i, j in powers
    ]
    of, with_ = ([[f.terms.get(key, Fraction(0)) for key in powers] for f in some] for some in (functions, others))
    common = lcm(*(x.denominator for row in [*of, *with_, *moments] for x in row))
    # In integers, as fractions are slow.
    A, M, B = (
        np.array([[int(x * common) for x in row] for row in rows], dtype=object) for rows in (of, moments, with_)
    )
    return A.dot(M).dot(B.T), common**3


@cache
def stiffness(order):
    """The three matrices of sides as fractions, (N, N) objects."""
    functions, found = basis(order), []
    for side in ALONG:
        along = [f.derivative(*side) for f in functions]
        products, scale = integrals(along, along)
        found.append(np.vectorize(lambda x, scale=scale: Fraction(x, scale), otypes=[object])(products))
    return found


def values(level, order, functions, triangle):
    """(N, m) of the basis on a triangle of a native level, in intervals, for functions as ElementForms::solve has them:
    coefficients of edges, from the lower vertex to the higher, values at vertices, coefficients inside."""
    corners, edges = level.triangles[triangle], level.triangle_edges[triangle]
    own, inner = order - 1, (order - 1) * (order - 2) // 2
    edge_count, vertex_count = int(level.triangle_edges.max()) + 1, int(level.triangles.max()) + 1
    at = exact(functions[edge_count * own + corners])
    classes = exact(level.classes[triangle].reshape(3, -1))
    rows = [at[1] - at[0] + classes[0], at[2] - at[0] - classes[2]]
    for i in range(3):
        runs_back = corners[i] > corners[(i + 1) % 3]
        for k in range(own):
            sign = -1 if runs_back and k % 2 else 1
            rows.append(exact(sign * functions[edges[i] * own + k]))
    first = edge_count * own + vertex_count + triangle * inner
    rows += list(exact(functions[first : first + inner]))
    return np.array(rows)


def gram(level, order, functions, growth=None):
    """Gram matrix, an `arb_mat`, on triangles with exactly the lengths of a level; energies times 1 + `growth`."""
    lengths = exact(level.lengths)[level.triangle_edges]
    squares = lengths * lengths
    R = [np.vectorize(lambda x: arb(fmpq(x.numerator, x.denominator)), otypes=[object])(m) for m in stiffness(order)]
    total = 0
    for t in range(len(level.triangles)):
        a, b, c = squares[t]
        area4 = (2 * (a * b + b * c + c * a) - a * a - b * b - c * c).sqrt()  # 4 A
        cotangents = [(b + c - a) / area4, (c + a - b) / area4, (a + b - c) / area4]
        X = values(level, order, functions, t)
        energy = sum(X.T.dot(m.dot(X)) * cot for m, cot in zip(R, cotangents, strict=True))
        total = total + energy * (1 + (0 if growth is None else arb(float(growth[t]))))
    return arb_mat(total.tolist())
