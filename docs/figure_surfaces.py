# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of the figures: grids, and isosurfaces of smooth unions of tori and balls."""

import itertools

import holomorph
import numpy as np


def surface_net(field, low, high, step):
    """Quads around {field < 0}: a vertex in each cell that the surface meets, a quad around each edge that it cuts."""
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high, strict=True)]
    inside = field(np.stack(np.meshgrid(*axes, indexing="ij"), -1)) < 0
    number = -np.ones(np.array(inside.shape) - 1, np.int64)
    corners = [inside[tuple(slice(i, n - 1 + i) for i, n in zip(o, inside.shape))] for o in np.ndindex(2, 2, 2)]
    cells = np.argwhere(np.any(corners, axis=0) & ~np.all(corners, axis=0))
    number[tuple(cells.T)] = np.arange(len(cells))
    vertices = np.array(low) + step * (cells + 0.5)
    quads = []
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        first, second = (
            np.take(inside, range(inside.shape[axis] - 1), axis),
            np.take(inside, range(1, inside.shape[axis]), axis),
        )
        cut = np.argwhere(first != second)
        around = []
        for i, j in ((0, 0), (-1, 0), (-1, -1), (0, -1)):
            cell = cut.copy()
            cell[:, b] += i
            cell[:, c] += j
            around.append(number[tuple(cell.T)])
        quad = np.stack(around, -1)
        quads.append(np.where(first[tuple(cut.T)][:, None], quad, quad[:, ::-1]))
    quads = np.concatenate(quads)
    for _ in range(12):  # evenly along the surface, then onto it
        total, count = np.zeros_like(vertices), np.zeros(len(vertices))
        for side in range(4):
            a, b = quads[:, side], quads[:, (side + 1) % 4]
            np.add.at(total, a, vertices[b])
            np.add.at(count, a, 1)
            np.add.at(total, b, vertices[a])
            np.add.at(count, b, 1)
        vertices = (vertices + total / count[:, None]) / 2
        for _ in range(3):
            value, e = field(vertices), 1e-4
            slope = np.stack([(field(vertices + e * d) - field(vertices - e * d)) / (2 * e) for d in np.eye(3)], -1)
            vertices = vertices - (value / (slope**2).sum(-1))[:, None] * slope
    return holomorph.Surface(vertices, quads)


def union(parts, sharpness):
    """Smooth union of solids given by their distances."""
    return lambda p: -np.log(sum(np.exp(-sharpness * part(p)) for part in parts)) / sharpness


def ring(x, y, major, minor):
    return lambda p: np.hypot(np.hypot(p[..., 0] - x, p[..., 1] - y) - major, p[..., 2]) - minor


def ball(x, y, z, radius):
    return lambda p: np.linalg.norm(p - np.array([x, y, z]), axis=-1) - radius


def double_torus(step=0.075):
    field = union([ring(-0.95, 0, 0.75, 0.27), ring(0.8, 0, 0.6, 0.27)], 9)
    return surface_net(field, (-2.2, -1.3, -0.6), (1.9, 1.3, 0.6), step)


def pretzel(step=0.075):
    around = [(0.87 * np.cos(a), 0.87 * np.sin(a)) for a in np.pi / 2 + np.array([0, 2, 4]) * np.pi / 3]
    sizes = [(0.6, 0.27), (0.6, 0.22), (0.6, 0.22)]
    field = union([ring(x, y, *size) for (x, y), size in zip(around, sizes, strict=True)], 9)
    return surface_net(field, (-1.9, -1.6, -0.6), (1.9, 2.1, 0.6), step)


def chain(step=0.08):
    field = union([ring(-1.75, 0, 0.72, 0.26), ring(0, 0, 0.62, 0.26), ring(1.5, 0, 0.5, 0.24)], 9)
    return surface_net(field, (-3.02, -1.31, -0.617), (2.6, 1.3, 0.6), step)


def bean(step=0.07):
    balls = (-0.9, -0.2, 0, 0.55), (-0.25, 0.25, 0, 0.45), (0.5, 0.1, 0.1, 0.42), (1.05, -0.35, 0, 0.4)
    field = union([ball(*numbers) for numbers in balls], 5)
    return surface_net(field, (-2.03, -1.31, -1.017), (2, 1.3, 1), step)


def torus(m=56, n=28):
    """A torus whose section is an ellipse, which makes a turn on its way around: tau is not imaginary."""
    i, j = np.divmod(np.arange(m * n), n)
    a, b = 2 * np.pi * i / m, 2 * np.pi * j / n
    x, y = 0.5 * np.cos(b), 0.26 * np.sin(b)
    x, y = x * np.cos(a) - y * np.sin(a), x * np.sin(a) + y * np.cos(a)
    vertices = np.stack([(1.1 + x) * np.cos(a), (1.1 + x) * np.sin(a), y], -1)
    right, up = (i + 1) % m * n, (j + 1) % n
    return holomorph.Surface(vertices, np.stack([i * n + j, right + j, right + up, i * n + up], -1))


def square_ring(n):
    """[-1, 1]^2 without [-1/2, 1/2]^2, n even cells of each quarter side."""
    k = 4 * n
    number = -np.ones((k + 1, k + 1), np.int64)
    i, j = np.meshgrid(range(k + 1), range(k + 1), indexing="ij")
    used = (np.abs(i - 2 * n) >= n) | (np.abs(j - 2 * n) >= n)
    number[used] = np.arange(used.sum())
    points = np.stack([i[used], j[used], 0 * i[used]], -1) / (2 * n) - [1, 1, 0]
    cell = np.argwhere((np.abs(i[:-1, :-1] + 0.5 - 2 * n) > n) | (np.abs(j[:-1, :-1] + 0.5 - 2 * n) > n))
    a, b = cell.T
    quads = np.stack([number[a, b], number[a + 1, b], number[a + 1, b + 1], number[a, b + 1]], -1)
    return holomorph.Surface(points, quads)


def eccentric_ring(m=72, n=16):
    """Between the unit circle and a circle of radius 0.3 about 0.38, cells of about equal sides: the Moebius image of a
    round ring, moved along its circles so that the grid is not the answer."""
    i, j = np.divmod(np.arange(m * (n + 1)), n + 1)
    t = j / n
    angle = 2 * np.pi * (i + 0.8 * t) / m
    rim, hole = np.exp(1j * angle), 0.38 + 0.3 * np.exp(1j * angle)
    z = (1 - t) * rim + t * hole
    right = (i + 1) % m * (n + 1)
    keep = j < n
    quads = np.stack([i * (n + 1) + j, right + j, right + j + 1, i * (n + 1) + j + 1], -1)[keep]
    return holomorph.Surface(np.stack([z.real, z.imag, 0 * z.real], -1), quads)


HOLES = ((-0.42, 0.28, 0.24), (0.45, 0.3, 0.18), (0.08, -0.45, 0.27))


def disk_with_holes(step=0.05):
    """The unit disk without three disks: a triangular grid whose boundary vertices are moved onto the circles."""
    rows = int(1.3 / (step * 3**0.5 / 2))
    columns = int(1.3 / step)
    i, j = np.meshgrid(np.arange(-rows, rows + 1), np.arange(-columns, columns + 1), indexing="ij")
    points = np.stack([step * (j + 0.5 * (i % 2)), step * 3**0.5 / 2 * i], -1).reshape(-1, 2)

    def level(p):
        holes = [r - np.hypot(p[..., 0] - x, p[..., 1] - y) for x, y, r in HOLES]
        return np.max([np.hypot(p[..., 0], p[..., 1]) - 1, *holes], axis=0)

    width, triangles = 2 * columns + 1, []
    for a, b in itertools.product(range(2 * rows), range(2 * columns)):
        p = a * width + b
        odd = (a - rows) % 2
        if odd:
            triangles += [(p, p + 1, p + width + 1), (p, p + width + 1, p + width)]
        else:
            triangles += [(p, p + 1, p + width), (p + 1, p + width + 1, p + width)]
    triangles = np.array(triangles)
    triangles = triangles[(level(points)[triangles] < -0.3 * step).all(axis=1)]
    while True:  # no vertex with two runs of triangles
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        ends, count = np.unique(edges, axis=0, return_counts=True)
        on_rim = np.bincount(ends[count == 1].ravel(), minlength=len(points))
        lonely = (count[np.unique(edges, axis=0, return_inverse=True)[1].reshape(-1, 3)] == 1).sum(1) > 1
        bad = (on_rim[triangles] > 2).any(axis=1) | lonely
        if not bad.any():
            break
        triangles = triangles[~bad]
    rim = np.unique(ends[count == 1])
    for circle in ((0, 0, 1), *HOLES):  # each rim vertex onto its nearest circle
        middle = np.array(circle[:2])
        away = points[rim] - middle
        distance = np.abs(np.linalg.norm(away, axis=1) - circle[2])
        nearest = distance < 1.6 * step
        points[rim[nearest]] = middle + circle[2] * away[nearest] / np.linalg.norm(away[nearest], axis=1)[:, None]
    used, triangles = np.unique(triangles, return_inverse=True)
    points = points[used]
    free = ~np.isin(used, rim)
    triangles = triangles.reshape(-1, 3)
    for _ in range(20):  # even again
        total, count = np.zeros_like(points), np.zeros(len(points))
        for a, b in ((0, 1), (1, 2), (2, 0)):
            for s, t in ((a, b), (b, a)):
                np.add.at(total, triangles[:, s], points[triangles[:, t]])
                np.add.at(count, triangles[:, s], 1)
        points[free] = (total / count[:, None])[free]
    return holomorph.Surface(np.column_stack([points, np.zeros(len(points))]), triangles)
