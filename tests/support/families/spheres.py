"""Spheres, disks and one-sided surfaces."""

import numpy as np

from families.handles import voxel_surface
from families.mesh import polygons, uniform
from families.tori import angles


def cube():
    return voxel_surface(np.ones((1, 1, 1)), ((0, 0),))


def tetrahedron():
    return uniform(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], ((0, 0),)
    )


def geodesic_sphere(n, jitter=0.0, seed=0):
    """The unit sphere as an icosahedron whose faces are cut into n^2: 10 n^2 + 2 vertices; `jitter` in edge lengths."""
    golden = (1 + 5**0.5) / 2
    corners = np.array(
        [np.roll([0, a, b * golden], shift) for shift in range(3) for a in (-1, 1) for b in (-1, 1)], dtype=float
    )
    distance = np.linalg.norm(corners[:, None] - corners, axis=2)
    near = np.isclose(distance, 2)
    a, b, c = (index for index in np.nonzero(near[:, :, None] & near[:, None] & near[None]))
    turn = np.einsum("ij,ij->i", np.cross(corners[b], corners[c]), corners[a])
    first = (a < b) & (a < c) & (turn > 0)
    i, j = (index[(np.add(*np.indices((n + 1, n + 1))) <= n)] for index in np.indices((n + 1, n + 1)))
    points, faces = [], []
    number = np.full((n + 2, n + 2), -1)
    number[i, j] = np.arange(len(i))
    up = np.stack([number[i, j], number[i + 1, j], number[i, j + 1]], axis=1)[i + j < n]
    down = np.stack([number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]], axis=1)[i + j < n - 1]
    for x, y, z in zip(corners[a[first]], corners[b[first]], corners[c[first]], strict=True):
        faces.append(np.concatenate([up, down]) + len(i) * len(points))
        points.append(x + np.outer(i, y - x) / n + np.outer(j, z - x) / n)
    points = np.concatenate(points)
    _, kept, index = np.unique(np.rint(points * 1e6).astype(int), axis=0, return_index=True, return_inverse=True)
    points = points[kept] / np.linalg.norm(points[kept], axis=1)[:, None]
    points += jitter * 1.1 / n * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    points /= np.linalg.norm(points, axis=1)[:, None]
    return uniform(points, index.reshape(-1)[np.concatenate(faces)], ((0, 0),))


def spun(n, m, cap="n-gon"):
    """A sphere spun from a half circle, as by Blender's Spin: n coincident vertices at each pole, closed by an n-gon,
    or by a fan around one vertex more."""
    theta, phi = np.arange(m + 1) * np.pi / m, 2 * np.pi * np.arange(n) / n
    radius = np.where(np.arange(m + 1) % m > 0, np.sin(theta), 0.0)
    points = np.stack([np.outer(radius, np.cos(phi)), np.outer(radius, np.sin(phi)), np.outer(np.cos(theta), phi**0)])
    points = points.reshape(3, -1).T
    faces = [[i * n + j, (i + 1) * n + j, (i + 1) * n + k, i * n + k] for i in range(m) for j, k in _around(n)]
    if cap == "n-gon":
        return polygons(points, [*faces, list(range(n)), list(range(m * n, (m + 1) * n))[::-1]], ((0, 0),))
    top, bottom = len(points), len(points) + 1
    fans = [[j, k, top] for j, k in _around(n)] + [[m * n + k, m * n + j, bottom] for j, k in _around(n)]
    return polygons(np.concatenate([points, points[[0, -1]]]), faces + fans, ((0, 0),))


def _around(n):
    return [(j, (j + 1) % n) for j in range(n)]


def hexagonal_disk(n, jitter=0.0, seed=0):
    """The unit disk (#V, 2) in n rings around vertex 0: 3 n (n + 1) + 1 points and 6 n^2 triangles. Interior points are
    moved, `jitter` in units of a ring."""
    q, r = (index.ravel() - n for index in np.indices((2 * n + 1, 2 * n + 1)))
    ring = np.maximum(np.abs(q), np.maximum(np.abs(r), np.abs(q + r)))
    order = np.argsort(ring, kind="stable")[: 3 * n * (n + 1) + 1]
    number = np.full((2 * n + 2, 2 * n + 2), -1)
    number[q[order] + n, r[order] + n] = np.arange(len(order))
    q, r, ring = q[order] + n, r[order] + n, ring[order]
    up = np.stack([number[q, r], number[q + 1, r], number[q, r + 1]], axis=1)
    down = np.stack([number[q, r], number[q, r + 1], number[q - 1, r + 1]], axis=1)
    faces = np.concatenate([up, down])
    lattice = (q - n) + (r - n) * np.exp(1j * np.pi / 3)
    z = ring / n * np.exp(1j * np.angle(lattice))
    noise = np.random.default_rng(seed).uniform(-1, 1, (2, len(z)))
    z = np.where(ring < n, z + jitter / n * (noise[0] + 1j * noise[1]), z)
    return np.stack([z.real, z.imag], axis=1), faces[(faces >= 0).all(axis=1)]


def hemisphere(n, jitter=0.0, seed=0):
    """The upper half of the unit sphere, its boundary on the equator, its pole at vertex 0."""
    disk, faces = hexagonal_disk(n, jitter, seed)
    radius = np.linalg.norm(disk, axis=1)
    factor = np.where(radius > 0, np.sin(np.pi / 2 * radius) / np.maximum(radius, 1e-300), np.pi / 2)
    points = np.column_stack([disk * factor[:, None], np.cos(np.pi / 2 * radius)])
    return uniform(points, faces, ((0, 1),))


def saw_blade(n=24, rings=2, tip=1.5):
    """A flat disk of rings with a tooth at each edge of its boundary: all corners of a tooth lie on the boundary."""
    turn, following = 2 * np.pi * np.arange(n) / n, (np.arange(n) + 1) % n
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    teeth = tip / 2 * (circle + circle[following])
    points = [np.zeros((1, 3)), *(radius * circle for radius in np.arange(1, rings + 1) / rings), teeth]
    here = 1 + n * np.arange(rings + 1)[:, None] + np.arange(n)
    after = here[:, following]
    faces = [[0, a, b] for a, b in zip(here[0], after[0])]
    for k in range(rings - 1):
        faces += np.stack([here[k], here[k + 1], after[k + 1], after[k]], axis=1).tolist()
    faces += np.stack([here[-2], here[-1], after[-2]], axis=1).tolist()
    return polygons(np.concatenate(points), faces, ((0, 1),))


def moebius(n=16, m=3):
    """A strip closed with a half turn: one-sided."""
    i, j = np.divmod(np.arange(n * m), m)
    theta, width = 2 * np.pi * i / n, (j / (m - 1) - 0.5)
    rho = 2 + width * np.cos(theta / 2)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), width * np.sin(theta / 2)], axis=1)
    row, col = np.divmod(np.arange(n * (m - 1)), m - 1)
    turned = row + 1 == n

    def vertex(d):
        return np.where(turned, m - 1 - (col + d), (row + 1) * m + col + d)

    return uniform(points, np.stack([row * m + col, vertex(0), vertex(1), row * m + col + 1], axis=1))


def klein_bottle(n=12, m=8):
    """A grid closed up with a reflection in one direction: closed and one-sided; the figure-8 form."""
    i, j = np.divmod(np.arange(n * m), m)
    turned = i + 1 == n
    right = np.where(turned, 0, i + 1)
    low, high = np.where(turned, (m - j) % m, j), np.where(turned, (m - j - 1) % m, (j + 1) % m)
    theta, phi = angles(n, m)
    rho = 2 + np.cos(theta / 2) * np.sin(phi) - np.sin(theta / 2) * np.sin(2 * phi)
    z = np.sin(theta / 2) * np.sin(phi) + np.cos(theta / 2) * np.sin(2 * phi)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    return uniform(points, np.stack([i * m + j, right * m + low, right * m + high, i * m + (j + 1) % m], axis=1))
