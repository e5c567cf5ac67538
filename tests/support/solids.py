"""Solids with hard edges."""

import families
import numpy as np
from holomorph import Surface
from solved import surface_of


def around(n, radius, height):
    turn = 2 * np.pi * np.arange(n) / n
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(n, height)], axis=1)


def cone(n=32):
    """As Blender makes it: triangles to the tip, vertex n, and a base of one face."""
    sides = [[i, (i + 1) % n, n] for i in range(n)]
    return Surface(np.concatenate([around(n, 1, -1), [[0, 0, 1]]]), [*sides, list(range(n))[::-1]])


def can(n=32):
    """A cylinder with one face for each cap."""
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    points = np.concatenate([around(n, 1, -1), around(n, 1, 1)])
    return Surface(points, [*sides, list(range(n))[::-1], list(range(n, 2 * n))])


def bracket():
    """Two plates at a right angle, with a square hole in one."""
    cells = np.ones((4, 4, 4), bool)
    cells[1:, :, 1:] = False
    cells[0, 1:3, 2] = False
    return surface_of(families.voxel_surface(cells, ((0, 0),)))


def revolved(*profile, sides=32, step=0.08):
    """A surface of revolution; profile: (radius, height) at its corners, closed where the radius is 0."""
    ends = zip(profile, profile[1:])
    parts = [
        np.linspace(a, b, max(2, round(np.hypot(b[0] - a[0], b[1] - a[1]) / step)), endpoint=False) for a, b in ends
    ]
    rows = np.concatenate([*parts, [profile[-1]]])
    angles = 2 * np.pi * np.arange(sides) / sides
    points, rings = [], []
    for radius, height in rows:
        ring = angles if radius > 0 else angles[:1]
        rings.append(len(points) + np.arange(len(ring)))
        points.extend(np.column_stack([radius * np.cos(ring), radius * np.sin(ring), np.full(len(ring), height)]))
    faces = []
    for below, above in zip(rings, rings[1:]):
        for i in range(sides):
            near, far = [ring[[i % len(ring), (i + 1) % len(ring)]] for ring in (below, above)]
            corners = [near[0], near[1], far[1], far[0]]
            faces.append(list(dict.fromkeys(int(v) for v in corners)))
    return Surface(np.array(points), faces)
