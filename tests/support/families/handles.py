"""Surfaces of any genus."""

from dataclasses import replace

import numpy as np

from families.mesh import polygons, uniform
from families.tori import grid_quads


def voxel_surface(cells, topology=()):
    """The boundary of a set of unit cubes as quads, outwards: `cells` is a three-dimensional array of bool."""
    padded = np.pad(np.asarray(cells, dtype=bool), 1)
    shape = np.array(padded.shape) + 1
    quads = []
    for axis in range(3):
        across = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) @ across
        for side in (0, 1):
            neighbour = np.roll(padded, -1 if side else 1, axis=axis)
            first = np.argwhere(padded & ~neighbour) + side * np.eye(3, dtype=int)[axis]
            quad = first[:, None] + (square if side else square[::-1])
            quads.append(np.ravel_multi_index(tuple(np.moveaxis(quad, -1, 0)), shape))
    used, faces = np.unique(np.concatenate(quads), return_inverse=True)
    vertices = np.stack(np.unravel_index(used, shape), axis=1) - 1.0
    return uniform(vertices, faces.reshape(-1, 4), topology)


def block_with_holes(genus, refine=1, jitter=0.0, seed=0):
    """A slab with `genus` square holes through it, its cubes cut into refine^3; `jitter` in units of a cube's edge."""
    cells = np.ones((2 * genus + 1, 3, 1), dtype=bool)
    cells[1::2, 1] = False
    for axis in range(3):
        cells = np.repeat(cells, refine, axis=axis)
    mesh = voxel_surface(cells, ((genus, 0),))
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, mesh.vertices.shape)
    return replace(mesh, vertices=(mesh.vertices + noise) / refine)


def cage():
    """The edges of a cube as square beams: genus 5."""
    cells = np.zeros((5, 5, 5), dtype=bool)
    middle = (np.indices(cells.shape) % 4 != 0).sum(axis=0)
    cells[middle <= 1] = True
    return voxel_surface(cells, ((5, 0),))


def scaffold(n):
    """The edges of n^3 cubes as square beams: a graph of (n + 1)^3 nodes, so genus #beams - #nodes + 1."""
    cells = np.zeros((2 * n + 1,) * 3, dtype=bool)
    cells[(np.indices(cells.shape) % 2 != 0).sum(axis=0) <= 1] = True
    return voxel_surface(cells, ((3 * n * (n + 1) ** 2 - (n + 1) ** 3 + 1, 0),))


def square_ring(k):
    """A square frame of square beams, genus 1, of 16 polygons: four-sided, with each side cut into k edges, so that
    every polygon has 4 k corners, most of them on straight lines."""
    profile = np.array([[2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0]])
    turns = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    coarse = np.array([[x * turn[0], x * turn[1], z] for turn in turns for x, z in profile])
    points, index, faces = [], {}, []
    for quad in grid_quads(4, 4):
        face = []
        for start, end in zip(quad, np.roll(quad, -1), strict=True):
            low, high = min(start, end), max(start, end)
            for step in range(k):
                along = step if start == low else k - step
                key = (low, high, along) if 0 < along < k else (start,)
                if key not in index:
                    index[key] = len(points)
                    points.append(coarse[low] + (coarse[high] - coarse[low]) * along / k)
                face.append(index[key])
        faces.append(face)
    return polygons(points, faces, ((1, 0),))


def washer(n):
    """A flat ring of square profile, genus 1, whose top and bottom are two C-shaped polygons of 2 n + 2 corners."""
    angle = np.pi * np.arange(2 * n) / n
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    layers = [np.column_stack([radius * circle, np.full(2 * n, z)]) for radius, z in ((1, 0), (2, 0), (2, 1), (1, 1))]
    inner0, outer0, outer1, inner1 = (np.arange(2 * n) + 2 * n * layer for layer in range(4))
    faces = []
    for half in (np.arange(n + 1), np.arange(n, 2 * n + 1) % (2 * n)):
        faces.append([*outer1[half], *inner1[half[::-1]]])
        faces.append([*inner0[half], *outer0[half[::-1]]])
    for low, high in ((outer0, outer1), (inner1, inner0)):
        faces += np.stack([low, np.roll(low, -1), np.roll(high, -1), high], axis=1).tolist()
    return polygons(np.concatenate(layers), faces, ((1, 0),))
