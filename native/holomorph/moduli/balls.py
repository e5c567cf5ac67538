"""Complex numbers with guaranteed error bounds (ball arithmetic)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.array_types import Complexes, Reals

ROUNDING = 2.0**-50  # relative, of one operation on complex numbers and of the error's own


@dataclass(frozen=True)
class Ball:
    """All complex numbers within `error` of `value`, or arrays of them; operations widen them by their own rounding."""

    value: Complexes | complex
    error: Reals | float = 0.0

    def __add__(self, other):
        return _rounded(self.value + other.value, self.error + other.error)

    def __mul__(self, other):
        value = self.value * other.value
        with np.errstate(invalid="ignore"):
            error = np.abs(self.value) * other.error + self.error * (np.abs(other.value) + other.error)
        return _rounded(value, np.where(np.isinf(self.error + other.error), np.inf, error))

    def __truediv__(self, other):
        least = np.abs(other.value) - other.error
        quotient = self.value / other.value
        with np.errstate(divide="ignore", invalid="ignore"):
            error = (self.error + np.abs(quotient) * other.error) / least
        return _rounded(quotient, np.where(least > 0, error, np.inf))

    def __pow__(self, exponent):
        return product([self] * exponent)


def _rounded(value, error):
    return Ball(value, error * (1 + 4 * ROUNDING) + ROUNDING * np.abs(value))


def total(balls):
    return sum(balls, Ball(0))


def product(balls):
    result = Ball(1)
    for ball in balls:
        result = result * ball
    return result
