"""Meshes that are flat, so that an invariant is known exactly, however their vertices lie in the plane.

Vertices move on a grid of dyadic numbers, onto each other too, so that triangles have no area, but none is turned over:
the surface stays the same rectangle or the same tube.
"""

import families
import mesh_mutations
import numpy as np

GRID = 2.0**-12


def rectangle(random):
    """(vertices, faces, corners, modulus) of a rectangle of triangles, the corners of which are its own."""
    n, m, height = random.randrange(1, 5), random.randrange(1, 5), 2.0 ** random.randrange(-6, 7)
    x, y = (index.ravel() for index in np.indices((n + 1, m + 1)))
    points = np.column_stack([x / n, y / m, 0.0 * x])
    inner = (x > 0) & (x < n) & (y > 0) & (y < m)
    faces = np.array([[i * (m + 1) + j for i, j in ((a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1))]
                      for a in range(n) for b in range(m)])  # fmt: skip
    faces = families.cut_quads(faces, alternate=random.random() < 0.5)
    points = np.round(points / GRID) * GRID
    for vertex in np.flatnonzero(inner):
        _move(points, faces, vertex, random)
    corners = [0, n * (m + 1), n * (m + 1) + m, m]
    return points * [1, height, 0], faces.tolist(), corners, height


def _move(points, faces, vertex, random):
    """Moves one vertex to a random place, or onto another vertex, if no triangle is then turned over."""
    old = points[vertex].copy()
    star = faces[(faces == vertex).any(axis=1)]
    if random.random() < 0.3:
        points[vertex] = points[random.choice(star.ravel().tolist())]
    else:
        step = [random.choice((0, 1, -1)) * random.random() for _ in range(2)]
        points[vertex, :2] += np.round(np.array(step) / 3 / GRID) * GRID
    if (_twice_the_areas(points, star) < 0).any():
        points[vertex] = old


def _twice_the_areas(points, faces):
    """Exact, as the coordinates are on the grid."""
    a, b, c = (points[faces[:, i], :2] for i in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def tube(random):
    """(vertices, faces, modulus) of a straight prism without ends; vertices slide along its edges."""
    n, m, height = random.randrange(3, 7), random.randrange(2, 5), 2.0 ** random.randrange(-5, 6)
    side = 2 * np.sin(np.pi / n)
    levels = np.sort(
        [[random.choice((random.random(), random.randrange(3) / 2)) for _ in range(m - 2)] for _ in range(n)]
    )
    z = height * np.column_stack([np.zeros(n), levels, np.ones(n)])
    theta = 2 * np.pi * np.arange(n) / n
    points = np.stack([np.outer(np.cos(theta), np.ones(m)), np.outer(np.sin(theta), np.ones(m)), z], axis=-1)
    quads = families.grid_quads(n, m).reshape(n, m, 4)[:, :-1].reshape(-1, 4)
    return points.reshape(-1, 3), families.cut_quads(quads, random.random() < 0.5).tolist(), height / (n * side)


def disguised(vertices, faces, corners, random):
    """The same surface with other numbers, some faces turned over, in another unit."""
    vertices = vertices * 2.0 ** random.choice((0, 0, 40, -40, 100, -100))
    order = list(range(len(vertices)))
    random.shuffle(order)
    new = np.argsort(order)
    faces = [[int(new[v]) for v in face] for face in faces]
    random.shuffle(faces)
    if random.random() < 0.3:
        _, faces = mesh_mutations.face_turned_over(vertices, faces, random)
    return vertices[order], faces, [int(new[c]) for c in corners]
