"""Invariants of y^2 = f(x) from the coefficients of f, in fractions: an oracle for those of the period matrix."""

from fractions import Fraction
from math import comb, factorial, prod


def derivative(form, x, y):
    """Differentiates sum_i form[i] X^(n-i) Y^i, x times by X and y times by Y."""
    n = len(form) - 1
    falling = [
        prod(range(n - i - x + 1, n - i + 1)) * prod(range(i - y + 1, i + 1)) * form[i] for i in range(y, n + 1 - x)
    ]
    return falling or [Fraction(0)]


def transvectant(f, g, k):
    """(f, g)_k of two binary forms, lists of coefficients."""
    m, n = len(f) - 1, len(g) - 1
    result = [Fraction(0)] * (m + n - 2 * k + 1)
    for i in range(k + 1):
        first, second = derivative(f, k - i, i), derivative(g, i, k - i)
        for p, a in enumerate(first):
            for q, b in enumerate(second):
                result[p + q] += (-1) ** i * comb(k, i) * a * b
    scale = Fraction(factorial(m - k) * factorial(n - k), factorial(m) * factorial(n))
    return [scale * value for value in result]


def igusa_clebsch(coefficients):
    """I2, I4, I6, I10 of a sextic, highest coefficient first, by Clebsch's A, B, C, D (Mestre 1991)."""
    f = [Fraction(c) for c in [0] * (7 - len(coefficients)) + list(coefficients)]
    i = transvectant(f, f, 4)
    delta, y1 = transvectant(i, i, 2), transvectant(f, i, 4)
    y3 = transvectant(i, transvectant(i, y1, 2), 2)
    A, B = transvectant(f, f, 6)[0], transvectant(i, i, 4)[0]
    C, D = transvectant(i, delta, 4)[0], transvectant(y3, y1, 2)[0]
    return (
        -120 * A,
        -720 * A**2 + 6750 * B,
        8640 * A**3 - 108000 * A * B + 202500 * C,
        -62208 * A**5 + 972000 * A**3 * B + 1620000 * A**2 * C - 3037500 * A * B**2 - 6075000 * B * C - 4556250 * D,
    )


def absolute(coefficients):
    """I2^5 / I10, I2^3 I4 / I10, I2^2 I6 / I10."""
    I2, I4, I6, I10 = igusa_clebsch(coefficients)
    return I2**5 / I10, I2**3 * I4 / I10, I2**2 * I6 / I10
