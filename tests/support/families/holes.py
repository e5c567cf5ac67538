"""Surfaces with holes."""

from dataclasses import replace

import numpy as np

from families.changed import selected_corners
from families.mesh import Mesh, uniform
from families.tori import angles, grid_quads, torus


def cylinder(n, m):
    """A tube without ends: genus 0, two boundary loops."""
    theta, height = angles(n, m)
    points = np.stack([np.cos(theta), np.sin(theta), height], axis=1)
    quads = grid_quads(n, m).reshape(n, m, 4)[:, :-1].reshape(-1, 4)
    return uniform(points, quads, ((0, 2),))


def punctured_torus(n=12, m=9):
    """A torus with one face missing: genus 1, one boundary loop."""
    mesh = torus(n, m)
    return replace(mesh, corners=mesh.corners[4:], offsets=mesh.offsets[:-1], topology=((1, 1),))


def without_faces(mesh, faces, topology):
    """Some polygons taken out; vertices that no polygon is left at go too."""
    kept = np.setdiff1d(np.arange(mesh.face_count), faces)
    take, offsets = selected_corners(mesh, kept)
    used, corners = np.unique(mesh.corners[take], return_inverse=True)
    return Mesh(mesh.vertices[used], corners, offsets, topology)


def punched(mesh, count, seed=0):
    """`count` holes, each of one polygon and no two with a common vertex, in a closed mesh."""
    taken, holes = np.zeros(len(mesh.vertices), dtype=bool), []
    for face in np.random.default_rng(seed).permutation(mesh.face_count):
        corners = mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]]
        if len(holes) < count and not taken[corners].any():
            holes.append(face)
            taken[corners] = True
    assert len(holes) == count
    return without_faces(mesh, holes, ((mesh.genus, count),))


def chord_torus(n=12, m=10):
    """A torus with a hole in the shape of a U, so that a chord cuts off the quad inside the U: all its corners lie on
    one loop, and so do both ends of the chord. A second hole is one edge away, which is a chord between loops."""
    quads = [(3, 3), (4, 3), (5, 3), (3, 4), (5, 4), (7, 3)]
    return without_faces(torus(n, m, jitter=0.1), [i * m + j for i, j in quads], ((1, 2),))


def flat_cells(mask, scale, jitter=0.0, seed=0, topology=()):
    """The unit squares of a plane that `mask` selects, centred and scaled; inner vertices may move."""
    nx, ny = np.array(mask.shape) + 1
    i, j = np.nonzero(mask)
    faces = np.stack([i * ny + j, (i + 1) * ny + j, (i + 1) * ny + j + 1, i * ny + j + 1], axis=1)
    inner = np.bincount(faces.ravel(), minlength=nx * ny) == 4
    noise = jitter * np.random.default_rng(seed).uniform(-1, 1, (nx * ny, 2)) * inner[:, None]
    points = np.stack(np.divmod(np.arange(nx * ny), ny), axis=1) - np.array(mask.shape) / 2 + noise
    used, corners = np.unique(faces, return_inverse=True)
    vertices = np.column_stack([scale * points[used], np.zeros(len(used))])
    return uniform(vertices, corners.reshape(-1, 4), topology)


def square_minus_square(k, jitter=0.0):
    """{max |x| < 1} without {max |x| <= 1/2}, cut into squares of side 1 / (2 k)."""
    mask = np.ones((4 * k, 4 * k), dtype=bool)
    mask[k:-k, k:-k] = False
    return flat_cells(mask, 1 / (2 * k), jitter, topology=((0, 2),))


def ring_of_revolution(radius, height, n):
    """The profile (radius, height) revolved around the z axis in n steps: genus 0, two loops, normals outwards for a
    profile that rises."""
    m = len(radius)
    theta = 2 * np.pi * np.arange(n) / n
    points = np.stack(
        [np.outer(np.cos(theta), radius), np.outer(np.sin(theta), radius), np.outer(np.ones(n), height)], axis=-1
    )
    quads = grid_quads(n, m).reshape(n, m, 4)[:, :-1].reshape(-1, 4)
    return uniform(points.reshape(-1, 3), quads, ((0, 2),))


def cube_corner(k, jitter=0.0, seed=0):
    """The part k <= x + y + z <= 2 k of the three faces of a cube at a corner: a ring of three trapezoids, four of
    which make `square_minus_square`. Inner vertices of a face may move in it."""
    random, points, index, faces = np.random.default_rng(seed), [], {}, []

    def vertex(x, y, z):
        key = (x, y, z)
        if key not in index:
            index[key] = len(points)
            inner = sum(c > 0 for c in key) == 2 and k < sum(key) < 2 * k
            points.append(np.array(key) + inner * (np.array(key) > 0) * jitter * random.uniform(-1, 1, 3))
        return index[key]

    for axis in range(3):
        for i, j in np.argwhere(np.add.outer(np.arange(2 * k), np.arange(2 * k)) < 2 * k):
            low, right, up, high = (
                np.roll((a, b, 0), axis) for a, b in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))
            )
            if i + j >= k:
                faces.append([vertex(*low), vertex(*right), vertex(*up)])
            if k <= i + j + 1 and i + j + 2 <= 2 * k:
                faces.append([vertex(*right), vertex(*high), vertex(*up)])
    return uniform(np.array(points) / k, faces, ((0, 2),))
