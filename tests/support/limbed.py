"""Balls with limbs, on which a map is stretched."""

from dataclasses import replace

import families
import numpy as np

TIPS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])  # directions


def limbs():
    """A ball with four long limbs, which begin abruptly."""
    ball = families.geodesic_sphere(10)
    points = ball.vertices.copy()
    for axis in TIPS / 3**0.5:
        height = ball.vertices @ axis
        points += 16 * np.outer(np.maximum(height - 0.75, 0), axis)
    return replace(ball, vertices=points)


def open_limbs(count=2):
    """Limbs, of which some have no end: a cut that joins tips lets such a body fall apart."""
    return without_tips(limbs(), TIPS[:count], 1.0)


def without_tips(mesh, axes, size):
    """What is nearer to the outermost vertices along some axes is left out."""
    tips = mesh.vertices[np.argmax(mesh.vertices @ np.transpose(axes), axis=0)]
    middles = mesh.vertices[mesh.corners.reshape(-1, 3)].mean(axis=1)
    is_near = np.linalg.norm(middles[:, None] - tips, axis=2).min(axis=1) < size
    return families.without_faces(mesh, np.flatnonzero(is_near), ())


def uneven(seed):
    """A ball with limbs: any number of them, of any length and direction, with and without ends."""
    rng = np.random.default_rng(seed)
    ball = families.geodesic_sphere(int(rng.integers(5, 9)))
    axes = rng.normal(size=(int(rng.integers(2, 7)), 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    height = np.maximum(ball.vertices @ axes.T - rng.uniform(0.6, 0.85), 0)
    body = replace(ball, vertices=ball.vertices + (height * rng.uniform(4, 20, len(axes))) @ axes)
    count = int(rng.integers(0, len(axes) + 1))
    return without_tips(body, axes[:count], rng.uniform(0.5, 1.2)) if count else body


def spikes():
    """A ball with three spikes."""
    ball = families.geodesic_sphere(12)
    factor = 1 + 6 * np.exp(-12 * (1 - ball.vertices.max(axis=1)))
    return replace(ball, vertices=ball.vertices * factor[:, None])


def bumps():
    """A ball with seven thick thorns."""
    ball = families.geodesic_sphere(20)
    points = ball.vertices / np.linalg.norm(ball.vertices, axis=1, keepdims=True)
    turn = 2.4 * np.arange(7)
    height = np.linspace(-0.9, 0.9, 7)
    around = np.sqrt(1 - height**2)
    tips = np.column_stack([around * np.cos(turn), around * np.sin(turn), height])
    return replace(ball, vertices=points * (1 + 0.8 * (np.maximum(points @ tips.T, 0) ** 12).sum(axis=1))[:, None])
