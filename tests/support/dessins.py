"""Surfaces glued of triangles, white and black in turn, by two permutations (Grothendieck's dessins): flat triangles of
any shape, for the surface is that of the Belyi map. Modular curves X_0(N) are among them."""

from itertools import product
from math import gcd

import families
import numpy as np

SHAPE = (np.pi / 3, np.pi / 2, np.pi / 6)  # angles over 0, 1 and infinity

# a1, a2, a3, a4, a6 of the curves y^2 + a1 x y + a3 y = x^3 + a2 x^2 + a4 x + a6 (Cremona's tables).
ELLIPTIC = {
    11: (0, -1, 1, -10, -20),
    14: (1, 0, 1, 4, -6),
    15: (1, 1, 1, -10, -10),
    17: (1, -1, 1, -1, -14),
    19: (0, 1, 1, -9, -15),
    20: (0, 1, 0, 4, 4),
    21: (1, 0, 0, -4, -1),
    24: (0, -1, 0, -4, 4),
}

# Coefficients of y^2 = f(x), that of the highest power first (Hasegawa 1995, doi:10.3792/pjaa.71.235): of genus 2,
# X_0(30) of genus 3.
HYPERELLIPTIC = {
    22: (1, 0, -4, 20, -40, 48, -32),
    23: (1, -8, 2, 2, -11, 10, -7),
    26: (1, -8, 8, -18, 8, -8, 1),
    28: (1, 0, 10, 0, 25, 0, 28),
    29: (1, -4, -12, 2, 8, 8, -7),
    31: (1, -8, 6, 18, -11, -14, -3),
    37: (1, 8, -20, 28, -24, 12, -4),
    50: (1, -4, 0, -10, 0, -4, 1),
    30: (1, 14, 79, 242, 441, 484, 316, 112, 16),
}


def curve(N):
    """Coefficients of y^2 = f(x) for X_0(N); elliptic ones are y^2 = 4 x^3 + b2 x^2 + 2 b4 x + b6."""
    if N in HYPERELLIPTIC:
        return HYPERELLIPTIC[N]
    a1, a2, a3, a4, a6 = ELLIPTIC[N]
    return 4, a1 * a1 + 4 * a2, 4 * a4 + 2 * a1 * a3, a3 * a3 + 4 * a6


def modular_permutations(N):
    """Those of the index of Gamma_0(N) in the modular group, on the projective line over Z/N: of the elliptic elements
    of orders 3 and 2, whose product is parabolic."""
    units = [u for u in range(1, N + 1) if gcd(u, N) == 1]
    number, points = {}, []
    for c, d in product(range(N), repeat=2):
        if gcd(gcd(c, d), N) == 1 and (c, d) not in number:
            number |= {(c * u % N, d * u % N): len(points) for u in units}
            points.append((c, d))

    def moved(a, b, c, d):
        return np.array([number[(x * a + y * c) % N, (x * b + y * d) % N] for x, y in points])

    return moved(0, -1, 1, 1), moved(0, -1, 1, 0)


def surface(around_0, around_1, shape=SHAPE):
    """`FlatSurface` of white triangles i and black ones d + i, which share their sides from 0 to 1. Around 0,
    counter-clockwise, white i, black around_0(i) and white around_0(i) follow each other; around 1 black j and white
    around_1(j)."""
    d = len(around_0)
    i, before = (
        np.arange(d),
        np.argsort(around_0),
    )  # across their sides from infinity to 0 black j meets white before(j)
    over_0, over_1, over_infinity = (
        families.components(d, i, p) + k * d for k, p in enumerate((around_0, around_1, around_1[around_0]))
    )
    white = np.stack([over_0, over_1, over_infinity], axis=1)
    black = np.stack([over_0, over_infinity[before], over_1], axis=1)
    faces = np.unique(np.concatenate([white, black]), return_inverse=True)[1].reshape(-1, 3)
    names = np.concatenate(
        [np.stack([d + i, 2 * d + i, i], axis=1), np.stack([d + around_1, i, 2 * d + before], axis=1)]
    )
    sides = np.sin(shape)
    lengths = np.concatenate([np.tile(sides, (d, 1)), np.tile(sides[[0, 2, 1]], (d, 1))])
    chi = faces.max() + 1 - 3 * d + 2 * d
    return families.FlatSurface(faces, lengths, names, genus=1 - chi // 2)


def modular_curve(N, shape=SHAPE):
    """X_0(N) as `FlatSurface`."""
    return surface(*modular_permutations(N), shape)
