"""Lawson's surface of genus 2 in the sphere S^3, {Im z^2 + Im w^3 = 0}: of the conformal type of xi_{2,1}, as it has
its symmetries.

With z = c e^{i alpha} and w = s e^{i beta} it is c^2 sin 2 alpha + s^3 sin 3 beta = 0: twelve patches, where these
sines have opposite signs, between great-circle arcs from the points (i^k, 0) to the points (0, e^{i l pi / 3}).
"""

import numpy as np

CLOSE = 9  # decimals that tell vertices apart
STEPS = 12  # steps of Newton's method


def lawson(n):
    """(points (#V, 4), triangles (#T, 3)) with n intervals on each arc: 12 (n - 1)^2 + 24 (n - 1) + 10 vertices."""
    u, v = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n, indexing="ij")
    patches = []
    for k in range(4):
        for m in range(1 - k % 2, 6, 2):
            turned = [(np.exp(0.5j * np.pi * (k + i)), np.exp(1j * np.pi / 3 * (m + i))) for i in (0, 1)]
            (z0, w0), (z1, w1) = turned
            z, w = (1 - u) * (1 - v) * z0 + u * v * z1, u * (1 - v) * w0 + (1 - u) * v * w1
            patches.append(_on_surface(np.stack([z.real, z.imag, w.real, w.imag], axis=-1).reshape(-1, 4)))
    points, vertex = np.unique(np.round(np.concatenate(patches), CLOSE) + 0.0, axis=0, return_inverse=True)
    grid = vertex.reshape(12, n + 1, n + 1)
    quads = np.stack([grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:]], axis=-1).reshape(-1, 4)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _on_surface(x):
    """The points moved onto the surface along its gradient."""
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    for _ in range(STEPS):
        z, w = x[:, 0] + 1j * x[:, 1], x[:, 2] + 1j * x[:, 3]
        values = (z**2 + w**3).imag
        gradient = np.stack([2 * z.imag, 2 * z.real, (3 * w**2).imag, (3 * w**2).real], axis=1)
        gradient -= (gradient * x).sum(axis=1, keepdims=True) * x
        square = (gradient**2).sum(axis=1)
        x = x - gradient * np.divide(values, square, out=np.zeros_like(values), where=square > 0)[:, None]
        x /= np.linalg.norm(x, axis=1, keepdims=True)
    return x


def in_space(points):
    """(#V, 3) their stereographic images, from a point off the surface."""
    turned = points @ np.linalg.qr(np.random.default_rng(0).normal(size=(4, 4)))[0]
    return turned[:, :3] / (1 - turned[:, 3:])


def chords(points, triangles):
    """(#T, 3) lengths of the sides, entry i opposite corner i, in four dimensions."""
    corners = points[triangles]
    return np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1), axis=2)
