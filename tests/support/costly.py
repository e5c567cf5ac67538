"""Small meshes that cost much where an algorithm compares all with all: vertices and polygons, about n of these."""

import numpy as np


def ring(n):
    angle = 2 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])


def fan(n):
    """The cap of a turned part: n triangles around one vertex."""
    return np.vstack([[0, 0, 0.3], ring(n)]), [[0, 1 + i, 1 + (i + 1) % n] for i in range(n)]


def bipyramid(n):
    """Two fans on one ring: two vertices have n / 2 neighbours each."""
    m = n // 2
    upper = [[0, 2 + i, 2 + (i + 1) % m] for i in range(m)]
    return np.vstack([[0, 0, 1], [0, 0, -1], ring(m)]), upper + [[1, b, a] for _, a, b in upper]


def polygon(n):
    """One polygon with n sides."""
    return ring(n), [list(range(n))]


def boxes(n):
    """Some n / 6 boxes of different sizes, apart from each other."""
    count = max(n // 6, 1)
    corner = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    sizes = np.random.default_rng(0).uniform(0.3, 0.9, (count, 1, 3))
    places = np.stack(np.unravel_index(np.arange(count), [int(np.ceil(count ** (1 / 3)))] * 3), axis=-1)
    faces = np.array(sides) + 8 * np.arange(count)[:, None, None]
    return (corner * sizes + places[:, None]).reshape(-1, 3), faces.reshape(-1, 4).tolist()


def spiral(n):
    """Around one vertex twice: it lies over itself when it is flat."""
    angle = 4 * np.pi * np.arange(n + 1) / n
    rim = np.column_stack([np.cos(angle), np.sin(angle), 0.02 * angle])
    return np.vstack([[0, 0, 0], rim]), [[0, 1 + i, 2 + i] for i in range(n)]


def stairs(n):
    """Round an axis ten times, in long steps."""
    height = [0, 0, 5.0] * np.arange(n + 1)[:, None] / n
    angle = 20 * np.pi * np.arange(n + 1) / n
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    return np.vstack([radius * circle + height for radius in (0.2, 1.0)]), [
        [i, n + 1 + i, n + 2 + i, i + 1] for i in range(n)
    ]


def soup(n):
    """Triangles apart from each other."""
    return np.random.default_rng(0).random((3 * n, 3)), np.arange(3 * n).reshape(-1, 3).tolist()


def star(n):
    """One polygon with n / 2 points."""
    return ring(n) * np.where(np.arange(n) % 2, 1.5, 1.0)[:, None], [list(range(n))]


def ribbon(n):
    """A coil, one quad wide."""
    angle = 0.1 * np.arange(n + 1)
    coil = [np.column_stack([r * np.cos(angle), r * np.sin(angle), 0.02 * angle]) for r in (1, 1.1)]
    return np.vstack(coil), [[i, i + 1, n + 2 + i, n + 1 + i] for i in range(n)]


def plate(n):
    """A grille: a plate with about n / 16 square holes."""
    holes = round((n / 16) ** 0.5)
    side = 3 * holes + 1
    places = np.arange(side)
    points = np.stack(np.meshgrid(places, places, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (each.ravel() for each in np.meshgrid(places[:-1], places[:-1], indexing="ij"))
    i, j = np.stack([i, j])[:, (i % 3 != 1) | (j % 3 != 1)]
    corners = (i * side + j, (i + 1) * side + j, (i + 1) * side + j + 1, i * side + j + 1)
    return np.column_stack([points, 0.05 * np.sin(points[:, 0])]), np.stack(corners, axis=1).tolist()


def latin(n):
    """The triangles of a Latin square, about n: a closed surface with half as many forms as triangles."""
    m = round((n / 2) ** 0.5)
    rows, columns = (each.ravel() for each in np.meshgrid(np.arange(m), np.arange(m), indexing="ij"))
    sums = 2 * m + (rows + columns) % m
    back = np.stack([m + columns, rows, 2 * m + (rows + columns + 1) % m], axis=1)
    faces = np.concatenate([np.stack([rows, m + columns, sums], axis=1), back])
    return np.random.default_rng(0).random((3 * m, 3)), faces.tolist()


SHAPES = {
    shape.__name__: shape for shape in (fan, bipyramid, polygon, boxes, spiral, stairs, soup, star, ribbon, plate)
}
