"""Meshes of thin triangles."""

import families
import numpy as np
from holomorph import Surface, rectangle_map

SQUARE = families.cut_quads(families.grid_quads(5, 5).reshape(5, 5, 4)[:4, :4].reshape(-1, 4))


def square_with(point, ends=(6, 12)):
    """The modulus of the unit square in 32 triangles, one more vertex at `point` beside the inner side with these ends,
    by default a diagonal, and its bounds."""
    x, y = (index.ravel() / 4 for index in np.indices((5, 5)))
    vertices = np.column_stack([x, y, 0 * x])
    faces = SQUARE.tolist()
    a, b = ends
    across = next(f for f in faces if a in f and b in f)
    apex = next(v for v in across if v not in (a, b))
    faces.remove(across)
    new = len(vertices)
    start, end = (a, b) if (across.index(b) - across.index(a)) % 3 == 1 else (b, a)
    faces += [[start, new, apex], [new, end, apex], [start, end, new]]
    surface = Surface(np.vstack([vertices, point(vertices[a], vertices[b])]), np.array(faces))
    return surface, rectangle_map(surface, [0, 20, 24, 4])


def refined_at(mesh, vertex, times, part):
    """A mesh of triangles, those at a vertex cut into three again and again: each ring of vertices around it is nearer
    than the last by the factor `part`, so that triangles between them are as thin as 1 - part."""
    points, faces = mesh.vertices, mesh.corners.reshape(-1, 3)
    for _ in range(times):
        is_here = (faces == vertex).any(axis=1)
        here = faces[is_here]
        _, a, b = np.take_along_axis(here, (np.argmax(here == vertex, axis=1)[:, None] + np.arange(3)) % 3, axis=1).T
        ring = np.unique(a)
        p, q = len(points) + np.searchsorted(ring, a), len(points) + np.searchsorted(ring, b)
        points = np.vstack([points, points[vertex] + part * (points[ring] - points[vertex])])
        cut = [np.full_like(p, vertex), p, q], [p, a, b], [p, b, q]
        faces = np.vstack([faces[~is_here], *(np.column_stack(corners) for corners in cut)])
    return families.uniform(points, faces, mesh.topology)


def needles(width, n=60, m=40):
    """A torus in which vertices nearly meet: triangles so thin that weights reach 1 / width."""
    mesh = families.torus(n, m, shape="triangles")
    points = mesh.vertices.copy()
    for triangle in mesh.corners.reshape(-1, 3)[::7]:
        points[triangle[0]] = (1 - width) * points[triangle[1]] + width * points[triangle[0]]
    return families.uniform(points, mesh.corners.reshape(-1, 3))


def layout(n, m, width, jitter=0.0, cut="random", seed=0, straight=False):
    """A strip 1 long and `width` high of n x m quads, cut along diagonals of any direction: the vertices' grid
    indices (#T, 3, 2) and their positions in the plane. The vertices between the two sides are moved up and down, if
    not `straight`; those of each row along by `jitter` of a step."""
    noise = np.random.default_rng(seed).uniform(-0.4, 0.4, (2, n, m + 1))
    inner = (np.arange(m + 1) > 0) & (np.arange(m + 1) < m) & (not straight)
    u = (np.arange(n)[:, None] + jitter * noise[0]) / n
    v = (np.arange(m + 1) + 0.8 * inner * noise[1]) * width / m
    i, j = np.divmod(np.arange(n * m), m)
    a, b, c, d = (np.stack([i + x, j + y], axis=1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    flipped = (cut == "random") * np.random.default_rng(seed).integers(2, size=n * m)[:, None, None] > 0
    grid = np.stack(
        [
            np.where(flipped, np.stack(p, 1), np.stack(q, 1))
            for p, q in (([a, b, d], [a, b, c]), ([b, c, d], [a, c, d]))
        ],
        1,
    ).reshape(-1, 3, 2)
    wrapped = grid[..., 0] % n, grid[..., 1]
    return grid, np.stack([u[wrapped] + (grid[..., 0] == n), v[wrapped]], axis=-1)


def glued(faces, corners):
    """An intrinsic surface of triangles laid out in the plane, (#T, 3, 2)."""
    sides = np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1)
    return Surface.from_edge_lengths(faces, np.hypot(*np.moveaxis(sides, -1, 0)))
