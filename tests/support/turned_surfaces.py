"""Surfaces under tilings that turn: a cube and a pillow, whose tiles can be counted, and meshes to make maps of."""

import families
import numpy as np
from holomorph import Surface, TiledSurface

SHAPES = {"cube": (4, 6), "pillow": (2, 2)}  # turns, faces of the box
WAYS = [((0, 1, 2), 1), ((0, 1, 2), -1), ((1, 2, 0), 1), ((1, 2, 0), -1), ((2, 0, 1), 1), ((2, 0, 1), -1)]


def square(count):
    """((V, 2) points of a unit square, (F, 4) its faces), counter-clockwise."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    a = (i * (count + 1) + j)[:-1, :-1].ravel()
    return np.stack([i, j], axis=-1).reshape(-1, 2) / count, np.stack([a, a + count + 1, a + count + 2, a + 1], axis=1)


def box(shape, tiles, shift, count=7):
    """(surface, uv) of a box whose faces have this number of tiles along each side; a pillow is a flat one with two
    faces. Its edges lie on lines of the tiling, or, with a shift of a half, between them."""
    flat, faces = square(count)
    points, uvs, corners = [], [], []
    for k, (axes, side) in enumerate(WAYS if shape == "cube" else WAYS[:2]):
        local = flat if side > 0 else np.array([1, 0]) + flat * (-1, 1)  # seen from outside, counter-clockwise
        at = np.full((len(flat), 3), (1 + side) / 2)
        at[:, axes[0]], at[:, axes[1]] = local.T
        if shape == "pillow":
            at[:, 2] = np.where((np.abs(local - 0.5) == 0.5).any(axis=1), 0.0, side * 1e-3)
        corners.append(faces + k * len(flat))
        points.append(at)
        uvs.append(flat * tiles + shift)
    points, uvs, corners = map(np.concatenate, (points, uvs, corners))
    found, index = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    return Surface(found, index.ravel()[corners]), uvs[corners.ravel()]


def tiled(shape, tiles, shift=0.0, **options):
    return TiledSurface(*box(shape, tiles, shift), turns=SHAPES[shape][0], **options)


MADE = {"ball": families.geodesic_sphere(12, jitter=0.2, seed=1), "torus": families.torus(40, 24, jitter=0.1, seed=2)}


def angles(on):
    """(#V,) around each vertex in the map, in full turns."""
    triangles, total = on.surface.triangles, np.zeros(len(on.surface.vertices))
    uv = on.uv[on.surface.triangle_corners] @ [1, 1j]
    for k in range(3):
        np.add.at(total, triangles[:, k], np.angle((uv[:, k - 1] - uv[:, k]) / (uv[:, k - 2] - uv[:, k])))
    return total / 2 / np.pi


def signed_area(on):
    a, b = (on.uv[on.surface.triangle_corners[:, k]] - on.uv[on.surface.triangle_corners[:, 0]] for k in (1, 2))
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2 / np.linalg.det(on.lattice)
