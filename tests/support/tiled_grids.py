"""Small maps whose tiles are known before anything is computed."""

import families
import numpy as np
from holomorph import Surface, TiledSurface
from solved import surface_of


def flat_square(shift, quads=4):
    """A square of quads in the plane, each a tile that is moved by `shift`: the surface, and UVs of its corners."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(quads + 1), np.arange(quads + 1)))
    first = (np.arange(quads)[:, None] * (quads + 1) + np.arange(quads)).ravel()
    faces = np.stack([first, first + 1, first + quads + 2, first + quads + 1], axis=1)
    surface = Surface(np.stack([x, y, 0 * x], axis=1).astype(float), faces)
    return surface, np.stack([x, y], axis=1)[surface.corner_vertices] + shift


def torus_uv(at, surface, columns, rows):
    """(#C, 2) of (#V, 2) `at`, up to whole turns of the torus; no triangle is larger than half of it."""
    uv = at[surface.corner_vertices].reshape(-1, 3, 2)
    size = np.array([columns, rows])
    return (uv - np.rint((uv - uv[:, :1]) / size) * size).reshape(-1, 2)


def grid_torus(n, m, columns, rows, shift=0.1, jitter=0.3):
    """A torus of n x m cells of two triangles, with so many tiles."""
    surface = surface_of(families.torus(n, m, shape="triangles"))
    i, j = np.divmod(np.arange(n * m), m)
    moved = np.random.default_rng(2).uniform(-jitter, jitter, (n * m, 2))
    at = (np.stack([i, j], axis=1) + moved) / [n, m] * [columns, rows] + shift
    return TiledSurface(surface, torus_uv(at, surface, columns, rows))


def folded_torus(seed, on_lines=0.4):
    """The same with vertices moved farther than their neighbours are, a part of them to lines between tiles."""
    n, m, columns, rows = 14, 11, 7, 5
    numbers = np.random.default_rng(seed)
    surface = surface_of(families.torus(n, m, shape="triangles"))
    i, j = np.divmod(np.arange(n * m), m)
    at = (np.stack([i, j], axis=1) + numbers.uniform(-1, 1, (n * m, 2))) / [n, m] * [columns, rows]
    on_line = numbers.random((n * m, 2)) < on_lines
    at = np.where(on_line, np.rint(at), at)
    return TiledSurface(surface, torus_uv(at, surface, columns, rows))
