"""Balls of complex numbers hold the exact values, and are at most ten times as large as rounding asks for."""

import operator

import numpy as np
import pytest
from flint import acb
from holomorph.moduli.igusa import Ball, multiplied, total
from interval_energies import exact  # and 200 bits

NEAR = 0.1  # part of each bound that some true error exceeds
OPERATIONS = {"+": operator.add, "*": operator.mul, "/": operator.truediv}


def numbers(seed, count=4000):
    """Complex ones of sizes from 1e-150 to 1e150."""
    random = np.random.default_rng(seed)
    return 10.0 ** random.uniform(-150, 150, count) * np.exp(2j * np.pi * random.uniform(size=count))


def parts(ball, true):
    """The true errors over the bounds."""
    missed = [abs(acb(complex(value)) - number).upper() for value, number in zip(ball.value, true)]
    return (np.array(missed) / exact(ball.error)).astype(float)


@pytest.mark.parametrize("sign", OPERATIONS)
def test_one_operation(sign):
    """The numbers are exact: rounding alone."""
    a, b = numbers(0), numbers(1)
    if sign == "+":
        b = b * np.abs(a) / np.abs(b)
    operation = OPERATIONS[sign]
    true = [operation(acb(complex(x)), acb(complex(y))) for x, y in zip(a, b)]
    found = parts(operation(Ball(a), Ball(b)), true)
    assert NEAR < found.max() <= 1


@pytest.mark.parametrize("sign", OPERATIONS)
def test_of_numbers_with_errors(sign):
    """The exact numbers may be anywhere in the balls: here at the ends, in directions of each other."""
    a, b, size = numbers(2) ** 0.1, numbers(3) ** 0.1, 1e-6
    balls = Ball(a, size * np.abs(a)), Ball(b, size * np.abs(b))
    operation, found = OPERATIONS[sign], []
    for s in (1 - 1e-12, -1 + 1e-12):
        for t in (1 - 1e-12, -1 + 1e-12):
            ends = [[acb(complex(z)) * (1 + acb(sign_ * size)) for z in of] for of, sign_ in ((a, s), (b, t))]
            found.append(parts(operation(*balls), [operation(x, y) for x, y in zip(*ends)]).max())
    assert 1 - 1e-5 < max(found) <= 1


def test_long_sums_and_products():
    random = np.random.default_rng(4)
    terms = [Ball(np.array([z])) for z in 1 + 0.1 * (random.normal(size=(300, 2)) @ [1, 1j])]
    for combined, true in ((total, acb(0)), (multiplied, acb(1))):
        for term in terms:
            value = acb(complex(term.value[0]))
            true = true + value if combined is total else true * value
        assert parts(combined(terms), [true]) <= 1


def test_a_quotient_by_what_may_be_0_is_anything():
    assert np.isinf((Ball(np.array([1.0])) / Ball(np.array([1.0]), np.array([1.0]))).error).all()
