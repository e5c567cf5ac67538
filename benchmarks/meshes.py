# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed surfaces of any size for the benchmarks: smooth, stretched, irregular and partly bad ones."""

import itertools

import numpy as np

# Cuts nearer than this to a grid point, in parts of an edge, are moved away from it: the slivers of a surface.
IRREGULAR, BAD = 0.05, 0.001


def torus(faces, stretch=1.0):
    """Vertices (#V, 3) and triangles (#F, 3) of a torus of revolution; cells are `stretch` times as long as wide."""
    across = round((faces / 5 * stretch) ** 0.5)
    around = round(faces / 2 / across)
    i, j = np.divmod(np.arange(around * across), across)
    theta, phi = 2 * np.pi * i / around, 2 * np.pi * j / across
    ring = 1 + 0.4 * np.cos(phi)
    vertices = np.stack([ring * np.cos(theta), ring * np.sin(theta), 0.4 * np.sin(phi)], -1)
    right, up = (i + 1) % around, (j + 1) % across
    a, b, c, d = i * across + j, right * across + j, right * across + up, i * across + up
    return vertices, np.stack([a, b, c, a, c, d], -1).reshape(-1, 3)


def bumpy_torus(faces):
    """An irregular torus: grid points moved by up to 0.3 of a step, the radius wavy."""
    m = round((faces / 4) ** 0.5)
    n = 2 * m
    i, j = np.divmod(np.arange(n * m), m)
    noise = np.random.default_rng(0).uniform(-0.3, 0.3, (2, n * m))
    theta, phi = 2 * np.pi * (i + noise[0]) / n, 2 * np.pi * (j + noise[1]) / m
    r = 1 + 0.1 * np.sin(5 * theta) * np.cos(3 * phi)
    rho = 2 + r * np.cos(phi)
    vertices = np.stack([rho * np.cos(theta), rho * np.sin(theta), r * np.sin(phi)], axis=1)
    right, up = (i + 1) % n, (j + 1) % m
    a, b, c, d = i * m + j, right * m + j, right * m + up, i * m + up
    return vertices, np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)


def double_torus(faces, nearest_cut=IRREGULAR):
    """A surface of genus 2 with about `faces` triangles by marching tetrahedra, as scans and volumes give them."""
    step = 0.05
    probe = len(_isosurface(_double_torus_field, step, nearest_cut)[1])
    return _isosurface(_double_torus_field, step * (probe / faces) ** 0.5, nearest_cut)


def _double_torus_field(x, y, z):
    return 0.03 - (x * x * (1 - x * x) - y * y) ** 2 - z * z


LOW, HIGH = np.array([-1.25, -0.75, -0.25]), np.array([1.25, 0.75, 0.25])


def _isosurface(field, step, nearest_cut):
    """Where field > 0 ends inside the box, by the six tetrahedra around a diagonal of each cube (Freudenthal)."""
    shape = np.ceil((HIGH - LOW) / step).astype(np.int64) + 1
    # Axes turned a little against the surface, so that no plane of the grid touches it along a curve.
    axes = [low + 0.37 * step + step * np.arange(count) for low, count in zip(LOW - step, shape + 1, strict=True)]
    values = field(axes[0][:, None, None], axes[1][None, :, None], axes[2][None, None, :])
    inside = values > 0
    corners = np.array(list(itertools.product((0, 1), repeat=3)))
    shape = np.array(values.shape)
    window = [inside[i : shape[0] - 1 + i, j : shape[1] - 1 + j, k : shape[2] - 1 + k] for i, j, k in corners]
    cubes = np.flatnonzero(np.any(window, axis=0) & ~np.all(window, axis=0))
    del window
    cubes = np.stack(np.unravel_index(cubes, shape - 1), -1)
    values, inside = values.ravel(), inside.ravel()
    outside_ends, inside_ends = [], []
    for order in itertools.permutations(range(3)):
        path = np.zeros((4, 3), np.int64)
        for step_number, axis in enumerate(order):
            path[step_number + 1 :, axis] = 1
        tetrahedra = np.ravel_multi_index(tuple(np.moveaxis(cubes[:, None, :] + path, -1, 0)), shape)
        for a, b in _triangles(tetrahedra, inside):
            inside_ends.append(a)
            outside_ends.append(b)
    return _welded(np.concatenate(inside_ends), np.concatenate(outside_ends), values, shape, axes, nearest_cut)


def _triangles(tetrahedra, inside):
    """Yields (#F, 3) inner and outer grid points of the edges that the triangles' corners cut."""
    # Inner points first in every row, so that there are three cases only.
    tetrahedra = np.take_along_axis(tetrahedra, np.argsort(~inside[tetrahedra], axis=1, kind="stable"), axis=1)
    count = inside[tetrahedra].sum(axis=1)
    for number, edges in (
        (1, ((0, 1), (0, 2), (0, 3))),
        (3, ((0, 3), (1, 3), (2, 3))),
        (2, ((0, 2), (0, 3), (1, 3))),
        (2, ((0, 2), (1, 3), (1, 2))),
    ):
        rows = tetrahedra[count == number]
        a, b = np.transpose(edges)
        yield rows[:, a], rows[:, b]


def _welded(a, b, values, shape, axes, nearest_cut):
    size = np.prod(shape)
    keys, triangles = np.unique(np.minimum(a, b) * size + np.maximum(a, b), return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    ends = np.stack([keys // size, keys % size])
    x, y = values[ends]
    t = np.clip(x / (x - y), nearest_cut, 1 - nearest_cut)[:, None]
    p, q = (np.stack([axis[i] for axis, i in zip(axes, np.unravel_index(e, shape), strict=True)], -1) for e in ends)
    vertices = (1 - t) * p + t * q
    # Counter-clockwise as seen from outside: the normal points from the inner ends to the outer ones.
    middle = [
        np.stack([axis[i].mean(axis=1) for axis, i in zip(axes, np.unravel_index(e, shape), strict=True)], -1)
        for e in (a, b)
    ]
    u, v, w = vertices[triangles].transpose(1, 0, 2)
    turned = np.einsum("ij,ij->i", np.cross(v - u, w - u), middle[1] - middle[0]) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    return vertices, triangles


def write_ply(path, vertices, triangles):
    """Binary PLY in double precision."""
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, triangles
    with open(path, "wb") as file:
        file.write(header.encode())
        np.ascontiguousarray(vertices, "<f8").tofile(file)
        rows.tofile(file)
    return path
