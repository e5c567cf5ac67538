"""Where poles are placed by themselves: in every spike of a ball one, at the corners of a polygon one at most."""

import families
import numpy as np
import pytest
from holomorph import Surface, Tiler, TopologyError, place_poles

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
    assert placed.size_range < 4.5
    assert place_poles(surface, 2).size_range > 1.41 * placed.size_range


def prism(around, rows):
    """A tube of quads, closed by a polygon at either end."""
    angle = 2 * np.pi * np.arange(around) / around
    heights = np.linspace(0, 4, rows + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    vertices = np.concatenate([np.pad(ring, ((0, 0), (0, 1)), constant_values=z) for z in heights])
    i, j = np.meshgrid(np.arange(rows), np.arange(around), indexing="ij")
    after = (j + 1) % around
    quads = np.stack([i * around + j, i * around + after, (i + 1) * around + after, (i + 1) * around + j], axis=-1)
    rim = np.arange(around)
    return Surface(vertices, [*quads.reshape(-1, 4).tolist(), rim[::-1].tolist(), (rows * around + rim).tolist()])


@pytest.mark.parametrize(("around", "rows", "poles"), [(32, 1, "auto"), (32, 1, 2), (32, 8, 6), (120, 45, 8)])
def test_a_polygon_has_one_pole_at_most(around, rows, poles):
    """Two corners of one face cannot both be poles; the last case is placed on a level, which has triangles only."""
    surface = prism(around, rows)
    made = Tiler(surface, poles).tile()
    row = made.poles // around
    assert (row == 0).sum() <= 1 and (row == rows).sum() <= 1
    assert made.added_distortion == 1


def test_a_prism_has_no_room_for_more():
    with pytest.raises(TopologyError, match="room for 2 of 4 poles"):
        place_poles(prism(32, 1), 4)
    with pytest.raises(TopologyError, match="two poles: the faces around any two vertices meet; subdivide"):
        place_poles(prism(4, 1))
