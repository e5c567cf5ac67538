"""Balls with limbs, on which a map is stretched."""

from dataclasses import replace

import families
import numpy as np


def limbs():
    """A ball with four long limbs, which begin abruptly."""
    ball = families.geodesic_sphere(10)
    points = ball.vertices.copy()
    for axis in np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / 3**0.5:
        height = ball.vertices @ axis
        points += 16 * np.outer(np.maximum(height - 0.75, 0), axis)
    return replace(ball, vertices=points)


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
