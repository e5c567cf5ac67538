"""Where poles are placed by themselves: in every spike of a ball one."""

import families
import numpy as np
import pytest
from holomorph import Surface, place_poles

LENGTH, WIDTH = 1.5, 0.25


def directions(count):
    """(count, 3) unit vectors far from each other, by repulsion."""
    points = np.random.default_rng(0).normal(size=(count, 3))
    for _ in range(200):
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        apart = points[:, None] - points
        distance = np.linalg.norm(apart, axis=2) + np.eye(count)
        points = points + 0.1 * (apart / distance[..., None] ** 3).sum(1)
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def spiky_ball(spikes):
    ball = families.geodesic_sphere(16)
    unit = ball.vertices / np.linalg.norm(ball.vertices, axis=1, keepdims=True)
    angles = np.arccos(np.clip(unit @ spikes.T, -1, 1))
    heights = 1 + LENGTH * np.exp(-((angles / WIDTH) ** 2)).sum(1)
    return Surface.from_polygons(unit * heights[:, None], ball.corners, ball.offsets)


@pytest.mark.parametrize("count", [5, 6, 8, 10])
def test_every_spike_has_its_pole(count):
    spikes = directions(count)
    surface = spiky_ball(spikes)
    placed = place_poles(surface, count)
    at = surface.vertices[placed.vertices]
    radius = np.linalg.norm(at, axis=1)
    assert radius.min() > 1 + LENGTH / 2
    assert len(set((at @ spikes.T).argmax(1))) == count
    assert placed.density_ratio < 20
    assert place_poles(surface, 2).density_ratio > 2 * placed.density_ratio
