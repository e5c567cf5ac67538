"""Curves y^2 = prod (x - a) by their branch points: families that are hard for an order of the points, and
Thomae's formula, which gives theta constants without periods."""

from itertools import combinations

import numpy as np
from holomorph.moduli.symplectic import even_theta_constants, siegel_reduction


def circle(count, radius=1.0, turn=0.0):
    return radius * np.exp(2j * np.pi * (np.arange(count) / count + turn))


NATURAL = {
    "pairs on the imaginary axis": np.array([1, 2, 3, -1, -2, -3]) * 1j,
    "pairs on the real axis": np.array([1, 2, 3, -1, -2, -3]) + 0j,
    "integers": np.array([0, 1, 2, 3, 5]) + 0j,
    "integers on a vertical line": 2 + 1j * np.arange(8),
    "x^6 - 1": circle(6),
    "x^8 - 1": circle(8),
    "x^7 - 1": circle(7),
    "x^5 - x": np.append(circle(4), 0),
    "x^7 - x": np.append(circle(6), 0),
    "x^8 + 14 x^4 + 1": np.roots([1, 0, 0, 0, 14, 0, 0, 0, 1]),
    "two circles": np.concatenate([circle(4), circle(4, 2.0)]),
    "two circles, turned": np.concatenate([circle(4), circle(4, 2.0, 0.125)]),
    "a cross": np.concatenate([np.array([-2, -1, 1, 2]) + 0j, np.array([-2, -1, 1, 2]) * 1j]),
    "a grid": (np.arange(3)[:, None] + 1j * np.arange(2)).ravel(),
    "a longer grid": (np.arange(4)[:, None] + 1j * np.arange(2)).ravel(),
    "Chebyshev": np.cos(np.pi * (np.arange(8) + 0.5) / 8) + 0j,
    "vertical pairs": np.concatenate([np.arange(4) + 0.5j, np.arange(4) - 0.5j]),
    "powers of two": 2.0 ** np.arange(6) + 0j,
    "far from 0": 100 + np.array([0, 1, 2, 3, 4, 1j]),
    "a far root": np.array([0, 1, 1j, -1, -1j, 1e6]),
}


def theta_sizes(omega):
    """The sorted sizes of the even theta constants of a period matrix, those that vanish left out, over their geometric
    mean, by the partitions of 2g + 2 points into halves, of which each has one."""
    g = len(omega)
    sizes = np.sort(np.abs(even_theta_constants(siegel_reduction(omega).period_matrix)))
    partitions = len(list(combinations(range(2 * g + 1), g)))
    return _over_mean(sizes[-partitions:])


def thomae_sizes(points):
    """The same from the branch points: theta^4 of a partition is the root of the product of all differences within its
    halves, times a constant (Thomae 1870; Mumford, Tata lectures on theta II, § 8). Infinity has no differences."""
    logs = np.log(np.abs(points[:, None] - points) + np.eye(len(points)))
    if len(points) % 2:
        logs = np.pad(logs, (0, 1))
    count = len(logs)
    halves = []
    for chosen in combinations(range(1, count), count // 2 - 1):
        inside = np.zeros(count, bool)
        inside[[0, *chosen]] = True
        halves.append((logs[np.ix_(inside, inside)].sum() + logs[np.ix_(~inside, ~inside)].sum()) / 2)
    return _over_mean(np.sort(np.exp((np.array(halves) - np.mean(halves)) / 4)))


def _over_mean(sizes):
    return sizes / np.exp(np.log(sizes).mean())
