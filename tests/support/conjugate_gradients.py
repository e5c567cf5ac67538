"""Conjugate gradients in NumPy: the paper's solver is compared with them."""

import numpy as np


def gradient_steps(edges, weights, b, scaled):
    """Iterations of conjugate gradients from zero, down to a relative residual of 1e-10 for every row of b."""
    n, head, tail = b.shape[1], edges[:, 1], edges[:, 0]

    def apply(x):
        y = weights * (x[:, head] - x[:, tail])
        return np.stack([np.bincount(head, f, n) - np.bincount(tail, f, n) for f in y])

    diagonal = np.bincount(head, weights, n) + np.bincount(tail, weights, n) if scaled else 1.0
    r = b.copy()
    p = r / diagonal
    rz = (r * p).sum(axis=1)
    count, goal = 0, 1e-10 * np.linalg.norm(b, axis=1)
    while (np.linalg.norm(r, axis=1) > goal).any():
        q = apply(p)
        r -= (rz / (p * q).sum(axis=1))[:, None] * q
        z = r / diagonal
        before, rz = rz, (r * z).sum(axis=1)
        p = z + (rz / before)[:, None] * p
        count += 1
    return count
